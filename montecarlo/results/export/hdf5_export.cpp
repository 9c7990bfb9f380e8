#include "montecarlo/results/export/hdf5_export.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/export/export_columns.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <H5Cpp.h>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace wingspread {
namespace {

using Kind = ExportColumn::Kind;

constexpr std::size_t waiting_bytes = std::size_t{32} << 20; // of all columns' rows
constexpr std::size_t most_chunk_bytes = std::size_t{1} << 20;
constexpr hsize_t least_chunk = 64, most_chunk = 16384; // rows
constexpr int deflate_level = 4; // level 6 takes twice the time and saves 1 % on random draws

/// The number of rows, and the lengths of the longest texts.
struct Extent {
  hsize_t rows = 0;
  std::size_t latch_order = 1, reason = 1; ///< bytes
};

Extent extent_of(const StoredCampaign& stored) {
  Extent extent;
  (void)for_each_stored_row(stored, [&](const ResultRow& row) {
    ++extent.rows;
    extent.latch_order = std::max(extent.latch_order, row.latch_order.size());
    extent.reason = std::max(extent.reason, row.reason.size());
  });
  return extent;
}

/// The library's error, and the system error behind it if there is one.
struct Failure {
  int error;
  std::string what;
};

/// The system error that the library met, from the text on top of its error stack.
int system_error() {
  int error = 0;
  const auto look = [](unsigned, const H5E_error2_t* entry, void* found) -> herr_t {
    const std::string text = entry->desc ? entry->desc : "";
    if (const std::size_t at = text.find("errno = "); at != std::string::npos)
      *static_cast<int*>(found) = std::atoi(text.c_str() + at + 8);
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &error);
  return error;
}

/// Calls a function that may fail on the device, and reads the error at once: the library's next call erases it.
template <class Action> void on_device(const Action& action) {
  try {
    action();
  } catch (const H5::Exception& exception) {
    throw Failure{system_error(), exception.getDetailMsg()};
  }
}

/// Redirects the file's remaining data into memory, where it is dropped. Otherwise closing a file that cannot be
/// written fails too: a destructor prints a message, and the library's exit ends the program.
void divert(const H5::H5File& file) {
  void* handle = nullptr;
  if (H5Fget_vfd_handle(file.getId(), H5P_DEFAULT, &handle) < 0) return;
  const int memory = memfd_create("forgotten", MFD_CLOEXEC);
  if (memory < 0) return;
  dup2(memory, *static_cast<int*>(handle));
  close(memory);
}

/// UTF-8, though the file calls it ASCII: Octave stops reading a file at the first text that is marked as UTF-8.
H5::StrType fixed_text(std::size_t bytes) {
  H5::StrType type(H5::PredType::C_S1, bytes);
  type.setStrpad(H5T_STR_NULLPAD);
  return type;
}

H5::DataType type_of(const ExportColumn& column, const Extent& extent) {
  switch (column.kind) {
  case Kind::run:
    return H5::PredType::STD_I64LE;
  case Kind::status: {
    std::size_t longest = 0;
    for (const Status status : statuses)
      longest = std::max(longest, std::string_view(to_string(status)).size());
    return fixed_text(longest);
  }
  case Kind::peaks_final:
    return H5::PredType::STD_I8LE;
  case Kind::latch_order:
    return fixed_text(extent.latch_order);
  case Kind::reason:
    return fixed_text(extent.reason);
  case Kind::draw:
  case Kind::output:
    break;
  }
  return H5::PredType::IEEE_F64LE;
}

/// Rows per chunk: few enough that the chunks of all columns, with the longest texts, fit into memory.
hsize_t chunk_rows(std::span<const ExportColumn> columns, const Extent& extent) {
  std::size_t row = 0, longest = 0;
  for (const ExportColumn& column : columns) {
    const std::size_t bytes = type_of(column, extent).getSize();
    row += bytes;
    longest = std::max(longest, bytes);
  }
  return std::clamp<hsize_t>(std::min(waiting_bytes / row, most_chunk_bytes / longest), least_chunk,
                             most_chunk);
}

/// @param text any length; read as str by h5py
void add_attribute(H5::H5Object& object, const char* name, const std::string& text) {
  H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
  type.setCset(H5T_CSET_UTF8);
  object.createAttribute(name, type, H5::DataSpace(H5S_SCALAR)).write(type, text);
}

template <class Integer>
void add_attribute(H5::H5Object& object, const char* name, const H5::PredType& type,
                   Integer value) {
  object.createAttribute(name, type, H5::DataSpace(H5S_SCALAR)).write(type, &value);
}

/// A column name as a link name: "/" separates groups and "." is the group itself.
std::string link_name(std::string name, std::set<std::string>& taken) {
  for (std::size_t at = 0; (at = name.find('/', at)) != std::string::npos;)
    name.replace(at, 1, "∕");
  if (name == ".") name = "_.";
  while (!taken.insert(name).second) name += '_';
  return name;
}

/// A column's dataset, and its values not yet written.
class ColumnWriter {
public:
  ColumnWriter(H5::Group& group, const ExportColumn& column, const std::string& link,
               const Extent& extent, hsize_t chunk)
      : kind_(column.kind), index_(column.index), type_(type_of(column, extent)), chunk_(chunk) {
    H5::DSetCreatPropList how;
    H5Pset_obj_track_times(how.getId(), false);
    if (extent.rows > 0) {
      const hsize_t rows = std::min(chunk, extent.rows);
      how.setChunk(1, &rows);
      how.setShuffle();
      how.setDeflate(deflate_level);
    }
    H5::DSetAccPropList access;
    access.setChunkCache(0, 0, 0); // whole chunks are written once
    set_ = group.createDataSet(link, type_, H5::DataSpace(1, &extent.rows), how, access);
    add_attribute(set_, "name", column.name);
    add_attribute(set_, "unit", column.unit);
    add_attribute(set_, "description", column.description);
    waiting_.reserve(chunk * type_.getSize());
  }

  void take(const ResultRow& row) {
    put(row);
    if (++count_ == chunk_) flush();
  }

  /// Call after the last row.
  void flush() {
    if (count_ == 0) return;
    const H5::DataSpace rows(1, &count_);
    H5::DataSpace place = set_.getSpace();
    place.selectHyperslab(H5S_SELECT_SET, &count_, &written_);
    on_device([&] { set_.write(waiting_.data(), type_, rows, place); });
    written_ += count_;
    count_ = 0;
    waiting_.clear();
  }

private:
  void put(const ResultRow& row) {
    switch (kind_) {
    case Kind::run:
      return put_bytes(std::int64_t{row.run});
    case Kind::status:
      return put_text(to_string(row.status));
    case Kind::draw:
      return put_bytes(row.draws[index_]);
    case Kind::output:
      return put_bytes(row.outputs[index_]);
    case Kind::peaks_final:
      return put_bytes(peaks_final_code(row.peaks_final.value_or(PeaksFinal::unknown)));
    case Kind::latch_order:
      return put_text(row.latch_order);
    case Kind::reason:
      return put_text(row.reason);
    }
  }

  static std::int8_t peaks_final_code(PeaksFinal final) {
    return static_cast<std::int8_t>(static_cast<int>(final) - 1);
  }

  template <class Number> void put_bytes(Number value) {
    waiting_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  void put_text(std::string_view text) {
    const std::size_t width = type_.getSize();
    waiting_.append(text.substr(0, width)).append(width - std::min(width, text.size()), '\0');
  }

  Kind kind_;
  std::size_t index_;
  H5::DataType type_;
  hsize_t chunk_, count_ = 0, written_ = 0;
  H5::DataSet set_;
  std::string waiting_; ///< bytes of the rows that are not yet written
};

void add_stamp(H5::H5Object& object, const StoredCampaign& stored) {
  add_attribute(object, "version", stored.stamp.version);
  add_attribute(object, "seed", H5::PredType::STD_U64LE, stored.stamp.seed);
  add_attribute(object, "hash", stored.stamp.hash);
  add_attribute(object, "campaign", json_text(stored.campaign.resolved));
  add_attribute(object, "runs", H5::PredType::STD_I64LE, std::int64_t{stored.runs().size()});
  if (stored.stamp.shard) add_attribute(object, "shard", describe(stored.stamp.shard));
  if (stored.stamp.preview) add_attribute(object, "preview", describe(*stored.stamp.preview));
}

void write_table(H5::Group& group, const StoredCampaign& stored) {
  refuse_without_rows(stored.folder);
  add_stamp(group, stored);
  const Extent extent = extent_of(stored);
  const std::vector<ExportColumn> columns =
      export_columns(stored.campaign, RunPlan(stored.campaign).names());
  const hsize_t chunk = chunk_rows(columns, extent);
  std::set<std::string> taken;
  std::vector<ColumnWriter> writers;
  writers.reserve(columns.size());
  for (const ExportColumn& column : columns)
    writers.emplace_back(group, column, link_name(column.name, taken), extent, chunk);
  hsize_t rows = 0;
  (void)for_each_stored_row(stored, [&](const ResultRow& row) {
    // A campaign that still runs may have appended rows since the first reading.
    if (rows++ >= extent.rows) return;
    for (ColumnWriter& writer : writers) writer.take(row);
  });
  for (ColumnWriter& writer : writers) writer.flush();
}

/// Properties of a group or file: links in order of creation, and no times.
void set_up_group(hid_t properties) {
  H5Pset_obj_track_times(properties, false);
  H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
}

H5::Group make_group(H5::H5File& file, const std::string& name) {
  const H5::PropList properties(H5P_GROUP_CREATE);
  set_up_group(properties.getId());
  const hid_t made =
      H5Gcreate2(file.getId(), name.c_str(), H5P_DEFAULT, properties.getId(), H5P_DEFAULT);
  if (made < 0) throw H5::GroupIException("make_group", "no group can be made");
  H5::Group group(made); // adds a reference, so the next line releases the first one
  H5Gclose(made);
  return group;
}

/// Writes the rows of the folder, or of each of its cases.
void write_tables(const StoredCampaign& stored, H5::H5File& file) {
  if (!is_cases_folder(stored.folder)) return write_table(file, stored);
  add_stamp(file, stored);
  std::set<std::string> taken;
  for (const CaseSpec& spec : made_cases(stored)) {
    H5::Group group = make_group(file, link_name(spec.name, taken));
    write_table(group, read_stored_campaign(stored.folder / spec.name));
  }
}

/// Properties without blocks that the library fills and shortens at the end: a file in memory then has the bytes of one
/// on the device.
H5::FileAccPropList without_blocks() {
  H5::FileAccPropList access;
  H5Pset_meta_block_size(access.getId(), 0);
  H5Pset_small_data_block_size(access.getId(), 0);
  return access;
}

void write_hdf5(const StoredCampaign& stored, const std::filesystem::path& path) {
  H5::FileCreatPropList properties;
  set_up_group(properties.getId());
  std::optional<H5::H5File> file;
  on_device([&] { file.emplace(path.string(), H5F_ACC_TRUNC, properties, without_blocks()); });
  try {
    on_device([&] { write_tables(stored, *file); });
    on_device([&] { file->flush(H5F_SCOPE_GLOBAL); });
  } catch (...) {
    divert(*file);
    throw;
  }
  on_device([&] { file->close(); });
}

/// Whether files may not grow beyond some size (ulimit -f). This holds in memory (divert) too.
bool has_file_limit() {
  rlimit limit{};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/// The bytes of the HDF5 file, made in memory.
std::string hdf5_image(const StoredCampaign& stored) {
  H5::FileCreatPropList properties;
  set_up_group(properties.getId());
  H5::FileAccPropList access = without_blocks();
  access.setCore(std::size_t{1} << 20, false);
  H5::H5File file("in memory", H5F_ACC_TRUNC, properties, access);
  write_tables(stored, file);
  file.flush(H5F_SCOPE_GLOBAL);
  std::string image(static_cast<std::size_t>(H5Fget_file_image(file.getId(), nullptr, 0)), '\0');
  H5Fget_file_image(file.getId(), image.data(), image.size());
  return image;
}

void refuse_special(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto found = std::filesystem::status(file, unknown);
  if (std::filesystem::exists(found) && !std::filesystem::is_regular_file(found))
    throw SpecError(
        {{file.string(), "", std::filesystem::is_directory(found) ? "a folder" : "no regular file",
          "a file: HDF5 goes back and forth in it"}});
}

} // namespace

bool has_hdf5() { return true; }

void export_hdf5(const std::filesystem::path& folder, const std::filesystem::path& file) {
  refuse_special(file);
  const StoredCampaign stored = read_any_campaign(folder);
  WholeFile whole(file);
  H5::Exception::dontPrint();
  constexpr const char* expected = "a file that can be written";
  try {
    if (has_file_limit())
      on_device([&] { whole.write(hdf5_image(stored)); });
    else
      write_hdf5(stored, whole.part());
  } catch (const Failure& failure) {
    if (failure.error != 0) refuse_path(file, failure.error, expected);
    throw MachineError({file.string(), "", "HDF5: " + failure.what, expected});
  }
  whole.finish();
}

} // namespace wingspread
