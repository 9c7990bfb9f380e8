#include "montecarlo/results/checkpoint/row_records.hpp"

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace wingspread {
namespace {

constexpr std::size_t enough_bytes = std::size_t{1} << 16;
constexpr signed char no_peaks_final = -1;

template <class T> void put(std::string& buffer, const T& value) {
  const auto at = buffer.size();
  buffer.resize(at + sizeof value);
  std::memcpy(buffer.data() + at, &value, sizeof value);
}

void put_text(std::string& buffer, std::string_view text) {
  put(buffer, static_cast<std::uint32_t>(text.size()));
  buffer += text;
}

/// FNV-1a, a word at a time.
std::uint64_t sum_of_draws(std::uint64_t sum, std::span<const double> draws) {
  for (const double draw : draws) sum = (sum ^ std::bit_cast<std::uint64_t>(draw)) * 0x100000001b3u;
  return sum;
}

void put_row(std::string& buffer, const ResultRow& row) {
  put(buffer, static_cast<unsigned char>(row.status));
  put(buffer, row.peaks_final ? static_cast<signed char>(*row.peaks_final) : no_peaks_final);
  for (const double output : row.outputs) put(buffer, output);
  put_text(buffer, row.latch_order);
  put_text(buffer, row.reason);
}

std::string framed(long first, std::uint32_t count, std::uint64_t draws, std::string_view rows) {
  std::string record(1, rows_mark);
  put(record, static_cast<std::int64_t>(first));
  put(record, count);
  put(record, draws);
  return record += rows;
}

/// Reads numbers and texts from a record, one after the other.
class BytesReader {
public:
  explicit BytesReader(std::string_view bytes) : bytes_(bytes) {}

  template <class T> T number() {
    T value{};
    const std::string_view own = take(sizeof value);
    if (!own.empty()) std::memcpy(&value, own.data(), sizeof value);
    return value;
  }
  std::string text() { return std::string(take(number<std::uint32_t>())); }

  [[nodiscard]] bool is_short() const { return short_; }
  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }

private:
  std::string_view take(std::size_t count) {
    short_ = short_ || count > bytes_.size();
    if (short_) return {};
    const std::string_view front = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return front;
  }

  std::string_view bytes_;
  bool short_ = false;
};

/// A row without its draws.
ResultRow take_row(BytesReader& bytes, long run, std::size_t outputs) {
  ResultRow row;
  row.run = run;
  row.status = static_cast<Status>(bytes.number<unsigned char>());
  const auto peaks = bytes.number<signed char>();
  if (peaks != no_peaks_final) row.peaks_final = static_cast<PeaksFinal>(peaks);
  for (std::size_t i = 0; i < outputs; ++i) row.outputs.push_back(bytes.number<double>());
  row.latch_order = bytes.text();
  row.reason = bytes.text();
  return row;
}

} // namespace

void for_each_record(std::span<const ResultRow> rows,
                     const std::function<void(std::string_view)>& take) {
  std::string bytes;
  std::uint64_t draws = 0;
  std::uint32_t count = 0;
  for (const ResultRow& row : rows) {
    put_row(bytes, row);
    draws = sum_of_draws(draws, row.draws);
    ++count;
    if (bytes.size() < enough_bytes && &row != &rows.back()) continue;
    take(framed(row.run + 1 - count, count, draws, bytes));
    bytes.clear();
    draws = count = 0;
  }
}

std::vector<ResultRow> rows_of_record(std::string_view record, const RunPlan& plan, RunRange next,
                                      const std::string& file) {
  BytesReader bytes(record.substr(1));
  const long first = bytes.number<std::int64_t>();
  const long count = bytes.number<std::uint32_t>();
  const auto recorded = bytes.number<std::uint64_t>();
  const auto refuse = [&] {
    throw SpecError({{file, "", fmt::format("rows with other draws from run {} on", next.first),
                      "those of this study, made by this program on one kind of machine"}});
  };
  if (bytes.is_short() || first != next.first || count > next.size()) refuse();
  std::vector<ResultRow> rows;
  std::uint64_t draws = 0;
  for (long run = first; run < first + count && !bytes.is_short(); ++run) {
    ResultRow& row = rows.emplace_back(take_row(bytes, run, plan.names().outputs.size()));
    row.draws.resize(plan.names().draws.size());
    plan.draw(run, row.draws);
    std::ranges::transform(row.draws, row.draws.begin(), finite_or_none);
    draws = sum_of_draws(draws, row.draws);
  }
  if (bytes.is_short() || !bytes.is_empty() || draws != recorded) refuse();
  return rows;
}

} // namespace wingspread
