// The native half of the Python module: exposes the C++ library (library/wingspread.hpp). Users call the functions of
// wingspread/__init__.py, which call these.
#include "montecarlo/interfaces/library/wingspread.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <new>
#include <pthread.h>
#include <string_view>
#include <system_error>
#include <thread>

namespace py = pybind11;

namespace wingspread::api {
namespace {

/// Heuristic: an optimiser may ask `evaluate` for a few rows again and again. If the last such call was quick, the next one
/// is made in the calling thread, and does not check for Ctrl-C.
constexpr py::ssize_t few_rows = 8;
constexpr std::chrono::milliseconds quick(50);

std::atomic<int> calls = 0; ///< under way, in any thread of Python
std::atomic<bool> is_python_ending = false;
/// The thread that ends Python, and may still call. Set before is_python_ending.
std::thread::id ending_thread;

/// Whether this thread has to end, because Python does.
bool has_to_end() { return is_python_ending && std::this_thread::get_id() != ending_thread; }

/// A call that releases the GIL. When Python ends, a thread that waits for the GIL ends inside C++, which aborts the process.
/// So Python waits for all calls before it ends (`end_calls`); SystemExit ends their threads, and those of later calls.
class Call {
public:
  Call() { // holds the GIL: end_calls counts it, or it sees that Python is ending
    if (has_to_end()) PyErr_SetNone(PyExc_SystemExit), throw py::error_already_set();
    ++calls;
  }
  ~Call() { --calls; }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
};

void end_calls() {
  ending_thread = std::this_thread::get_id();
  is_python_ending = true;
  const py::gil_scoped_release release;
  while (calls > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

enum class OnStop : std::uint8_t { wait, leave };

/// Runs `work` in a thread of its own, without the GIL, while this thread checks for Ctrl-C.
/// @param work is called with a flag that, once true, tells it to stop. It owns what it uses, nothing of Python's
/// @param on_stop leave: a second after a stop the call ends, and the work goes on alone until it sees the flag: one
///   deployment may take minutes. wait: for work that writes files
template <class Work> auto run_interruptibly(Work work, OnStop on_stop = OnStop::leave) {
  const Call call;
  const auto stop = std::make_shared<std::atomic<bool>>(false);
  std::packaged_task task([work = std::move(work), stop] { return work(*stop); });
  auto future = task.get_future();
  std::thread(std::move(task)).detach();
  const auto is_done = [&](std::chrono::milliseconds most) {
    const py::gil_scoped_release release;
    return future.wait_for(most) == std::future_status::ready;
  };
  while (!is_done(std::chrono::milliseconds(50))) {
    if (has_to_end())
      PyErr_SetNone(PyExc_SystemExit);
    else if (PyErr_CheckSignals() == 0)
      continue;
    *stop = true;
    while (!is_done(std::chrono::seconds(1)) && on_stop == OnStop::wait) {
    }
    throw py::error_already_set();
  }
  return future.get();
}

/// Text of the program. A path may have bytes that are no UTF-8: they are shown as \xff.
py::str text_of(std::string_view text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace"));
}

py::list texts_of(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(text_of(text));
  return list;
}

/// A read-only numpy view of memory that the owner keeps alive.
template <class T> py::array view(std::span<const T> values, const py::object& owner) {
  py::array_t<T> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array runs_of(const py::object& self) { return view(self.cast<const Table&>().runs(), self); }

py::array numbers_of(const py::object& self, const std::string& column) {
  return view(self.cast<const Table&>().numbers(column), self);
}

py::tuple words_of(const py::object& self, const std::string& column) {
  const auto [texts, codes] = self.cast<const Table&>().words(column);
  return py::make_tuple(view(codes, self), std::vector<std::string>(texts.begin(), texts.end()));
}

py::list reasons_of(const Table& table) {
  py::list reasons;
  for (std::size_t row = 0; row < table.size(); ++row) reasons.append(table.reason(row));
  return reasons;
}

Table run_it(const Input& input, std::optional<std::int64_t> runs,
             std::optional<std::uint64_t> seed, int threads, const std::string& of_case,
             const std::vector<std::string>& set) {
  return run_interruptibly([=](const std::atomic<bool>& stop) {
    return run(input, {runs, seed, threads, of_case, set, &stop});
  });
}

py::tuple simulate_it(const Input& input, const Settings& settings, std::optional<double> interval,
                      bool check) {
  const Outcome outcome = run_interruptibly([=](const std::atomic<bool>& stop) {
    return simulate(input, settings, interval, check, &stop);
  });
  py::dict trajectory;
  for (const Series& series : outcome.trajectory)
    trajectory[py::str(series.name)] =
        py::array_t<double>(static_cast<py::ssize_t>(series.values.size()), series.values.data());
  return py::make_tuple(outcome.json, trajectory, texts_of(outcome.notices));
}

py::tuple fit_it(const Input& campaign, const Input& tests, const std::filesystem::path& out,
                 std::optional<std::uint64_t> seed, long runs, int threads, bool resume) {
  const Fit made = run_interruptibly(
      [=](const std::atomic<bool>& stop) {
        return fit(campaign, tests, {out, seed, runs, threads, &stop, resume});
      },
      OnStop::wait);
  py::dict posterior;
  for (const Series& series : made.posterior)
    posterior[py::str(series.name)] =
        py::array_t<double>(static_cast<py::ssize_t>(series.values.size()), series.values.data());
  return py::make_tuple(made.json, posterior, texts_of(made.notices));
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A model that notes whether its last call with few rows was quick.
struct PacedModel : Model {
  using Model::Model;
  mutable std::atomic<bool> was_quick = false;
};

/// A numpy array that owns these rows.
py::array array_of(std::vector<double>&& values, py::ssize_t rows, py::ssize_t columns) {
  auto kept = std::make_unique<std::vector<double>>(std::move(values));
  double* data = kept->data();
  const py::capsule owner(kept.get(),
                          [](void* at) { delete static_cast<std::vector<double>*>(at); });
  (void)kept.release();
  return py::array_t<double>({rows, columns}, data, owner);
}

py::array evaluate_it(const PacedModel& model, const Numbers& x, int threads) {
  const auto parameters = static_cast<py::ssize_t>(model.parameters());
  if (x.ndim() != 2 || x.shape(1) != parameters)
    throw py::value_error("found x of shape " + std::string(py::str(x.attr("shape"))) +
                          ", expected (n, " + std::to_string(parameters) + ")");
  const py::ssize_t rows = x.shape(0), outputs = static_cast<py::ssize_t>(model.outputs().size());
  auto evaluate = [model = Model(model), threads, from = std::vector(x.data(), x.data() + x.size()),
                   size = static_cast<std::size_t>(rows * outputs)](const std::atomic<bool>& stop) {
    std::vector<double> to(size);
    (void)model.evaluate(from, to, threads, &stop);
    return to;
  };
  if (rows > few_rows) return array_of(run_interruptibly(std::move(evaluate)), rows, outputs);
  const auto began = std::chrono::steady_clock::now();
  std::vector<double> made;
  if (model.was_quick) {
    const Call call;
    const py::gil_scoped_release release;
    made = evaluate(false);
  } else {
    made = run_interruptibly(std::move(evaluate));
  }
  model.was_quick = std::chrono::steady_clock::now() - began < quick;
  return array_of(std::move(made), rows, outputs);
}

void add_errors(py::module_& module) {
  static py::handle spec_error, machine_error; // the interpreter owns them until it ends
  spec_error = py::exception<SpecError>(module, "SpecError", PyExc_ValueError).release();
  machine_error = py::exception<MachineError>(module, "MachineError", PyExc_OSError).release();
  spec_error.attr("__doc__") = "Wrong input; `problems` lists (file, place, found, expected)";
  spec_error.attr("problems") = py::tuple();
  machine_error.attr("__doc__") = "The machine lacks memory, disk space or a permission";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const SpecError& error) {
      py::list problems;
      for (const auto& [file, pointer, found, expected] : error.problems())
        problems.append(
            py::make_tuple(text_of(file), text_of(pointer), text_of(found), text_of(expected)));
      const py::object raised = spec_error(text_of(error.what()));
      raised.attr("problems") = problems;
      PyErr_SetObject(spec_error.ptr(), raised.ptr());
    } catch (const MachineError& error) {
      PyErr_SetObject(machine_error.ptr(), text_of(error.what()).ptr());
    } catch (const std::system_error& error) { // from threads
      PyErr_SetObject(machine_error.ptr(), text_of(error.what()).ptr());
    } catch (const std::bad_alloc&) {
      PyErr_SetString(machine_error.ptr(), "the machine has not enough memory");
    }
  });
}

} // namespace

PYBIND11_MODULE(_native, module) {
  module.doc() = "The native half of wingspread; use the module wingspread";
  add_errors(module);
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
  pthread_atfork(nullptr, nullptr, [] { calls = 0; }); // the parent's calls are not the child's
  module.def("version", &version, "The library's version");

  py::class_<Input>(module, "Input", "A scene or a campaign in JSON")
      .def_static("from_file", &from_file, py::arg("file"))
      .def_static("from_text", &from_text, py::arg("json"), py::arg("directory"));

  py::class_<Settings>(module, "Settings", "Settings of one deployment")
      .def(py::init([](std::vector<std::string> set, std::string of_case,
                       std::optional<std::string> method, std::optional<std::string> latch,
                       std::optional<double> step, std::optional<double> rtol,
                       std::optional<double> atol, std::optional<double> t_end) {
             return Settings{std::move(set),
                             std::move(of_case),
                             std::move(method),
                             std::move(latch),
                             step,
                             rtol,
                             atol,
                             t_end};
           }),
           py::arg("set"), py::arg("of_case"), py::arg("method"), py::arg("latch"), py::arg("step"),
           py::arg("rtol"), py::arg("atol"), py::arg("t_end"));

  py::class_<Table>(module, "Table", "The rows of a campaign, by columns")
      .def_property_readonly("size", &Table::size)
      .def_property_readonly("columns", &Table::columns)
      .def_property_readonly("draws", &Table::draws)
      .def_property_readonly("outputs", &Table::outputs)
      .def_property_readonly("is_complete", &Table::is_complete)
      .def_property_readonly("campaign", &Table::campaign)
      .def_property_readonly("notices",
                             [](const Table& table) { return texts_of(table.notices()); })
      .def("runs", &runs_of, "The runs' numbers, a view")
      .def("numbers", &numbers_of, py::arg("column"), "A draw or an output, a view")
      .def("words", &words_of, py::arg("column"), "A view of codes, and the texts that they index")
      .def("reasons", &reasons_of, "Why the wing did not deploy, by run");

  py::class_<PacedModel>(module, "Model", "A wing as a function of some of its parameters")
      .def(py::init<const Input&, const std::vector<std::string>&, std::vector<std::string>,
                    const Settings&>(),
           py::arg("input"), py::arg("paths"), py::arg("outputs"), py::arg("settings"))
      .def_property_readonly("outputs", &PacedModel::outputs)
      .def_property_readonly("nominal", &PacedModel::nominal)
      .def_property_readonly("notices",
                             [](const PacedModel& model) { return texts_of(model.notices()); })
      .def("evaluate", &evaluate_it, py::arg("x"), py::arg("threads"),
           "Returns a row of outputs for each row of parameters");

  module.def("run", &run_it, py::arg("input"), py::arg("runs"), py::arg("seed"), py::arg("threads"),
             py::arg("of_case"), py::arg("set"), "Makes a campaign's runs");
  module.def("simulate", &simulate_it, py::arg("input"), py::arg("settings"), py::arg("interval"),
             py::arg("check"),
             "Returns the outcome as JSON, the trajectory's columns, and the input's warnings");
  module.def("fit", &fit_it, py::arg("campaign"), py::arg("tests"), py::arg("out"), py::arg("seed"),
             py::arg("runs"), py::arg("threads"), py::arg("resume"),
             "Returns fit.json and the posterior's columns");
  module.def("read", &read, py::arg("folder"), py::arg("of_case"),
             "Reads the rows of a results folder");
}

} // namespace wingspread::api
