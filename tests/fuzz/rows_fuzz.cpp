/// Reads the rows of a results folder from any bytes. They are refused with a reason; or they read back to the same rows
/// when written, the kept length of a file with a torn last line holds all rows that were read, and their statistics can
/// be written as JSON and CSV.
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "tests/fuzz/fuzz.hpp"

#include <sstream>

using namespace wingspread;

namespace {

const ResultNames names{{"spring", "mass.a"},
                        {"root.latch_time", "root.peak_moment", "deployment_time"}};

ResultsFile read(const std::string& text, UnterminatedRow last) {
  std::istringstream in(text);
  return read_results(in, "runs.csv", names, last);
}

std::string written(const Results& results) {
  std::string text;
  append_header(text, names);
  for (std::size_t i = 0; i < results.size(); ++i) append_row(text, results.row(i));
  return text;
}

void summarize_all(const Results& results) {
  StatisticsSpec spec;
  const Summary summary = summarize(results, spec, {}, 1);
  test::demand(summary.runs == static_cast<long>(results.size()), "no run is lost in the summary");
  (void)json_text(summary_json(summary, {}));
  (void)histograms_csv(summary);
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(test::text_of(data, size));
  ResultsFile whole, kept;
  if (test::takes([&] { kept = read(text, UnterminatedRow::drop); })) {
    test::demand(kept.complete_bytes <= text.size(), "what is kept is part of the file");
    const std::string head = text.substr(0, kept.complete_bytes);
    test::demand(written(read(head, UnterminatedRow::drop).results) == written(kept.results),
                 "what is kept of the file has the rows that were read");
  }
  if (!test::takes([&] { whole = read(text, UnterminatedRow::read); })) return 0;
  const std::string once = written(whole.results);
  test::demand(written(read(once, UnterminatedRow::read).results) == once,
               "rows read back to themselves");
  if (whole.results.size() < 200) summarize_all(whole.results);
  return 0;
}
