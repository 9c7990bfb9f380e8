/// StreamingStatistics as bytes.
#include "montecarlo/results/streaming/streaming_statistics.hpp"

namespace wingspread {
namespace {

void put_count(StateWriter& to, long count) { to.put(static_cast<std::int64_t>(count)); }
void get_count(StateReader& from, long& count) {
  count = static_cast<long>(from.get<std::int64_t>());
}

void put_texts(StateWriter& to, const std::vector<std::string>& texts) {
  to.put(std::uint64_t{texts.size()});
  for (const std::string& text : texts) to.put(std::string_view(text));
}

std::vector<std::string> get_texts(StateReader& from) {
  std::vector<std::string> texts(from.get_count(sizeof(std::uint64_t)));
  for (std::string& text : texts) text = from.get_text();
  return texts;
}

void put_scale(StateWriter& to, const Scale& scale) {
  to.put(scale.shift);
  to.put(scale.per_unit);
}

Scale get_scale(StateReader& from) {
  Scale scale;
  scale.shift = from.get<double>();
  scale.per_unit = from.get<double>();
  return scale;
}

} // namespace

void StreamingStatistics::write(StateWriter& to) const {
  put_count(to, runs_);
  for (const long count : status_) put_count(to, count);
  for (const long count : peaks_) put_count(to, count);
  for (const Output& output : outputs_) {
    output.values.write(to);
    put_scale(to, output.scale);
    output.sums.write(to);
    put_count(to, output.beyond_stowed);
  }
  for (const StoppedPopulation& hinge : stopped_) hinge.angles.write(to);
  for (const auto& [values, worse] : populations_) {
    values.write(to);
    put_count(to, worse);
  }
  for (const auto& [failures, cut, open, absent, worst] : requirement_counts_) {
    put_count(to, failures);
    put_count(to, cut);
    put_count(to, open);
    put_count(to, absent);
    worst.write(to);
  }
  for (const Scale& scale : draw_scales_) put_scale(to, scale);
  if (correlations_) correlations_->write(to);
  to.put(std::uint64_t{orders_.size()});
  for (const auto& [order, count] : orders_) {
    to.put(std::string_view(order));
    put_count(to, count);
  }
  put_count(to, other_orders_);
  to.put(std::uint64_t{reasons_.groups.size()});
  for (const auto& [key, reason] : reasons_.groups) {
    to.put(static_cast<std::uint8_t>(key.first));
    put_texts(to, key.second);
    put_texts(to, reason.pattern.numbers);
    put_count(to, reason.count);
  }
}

StreamingStatistics::StreamingStatistics(const Campaign& campaign, const ResultNames& names,
                                         StateReader& from)
    : StreamingStatistics(campaign, names) {
  get_count(from, runs_);
  for (long& count : status_) get_count(from, count);
  for (long& count : peaks_) get_count(from, count);
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    Output output{Population(Grid{}), {}, {}};
    output.values.read(from);
    output.scale = get_scale(from);
    output.sums.read(from);
    get_count(from, output.beyond_stowed);
    outputs_.push_back(std::move(output));
  }
  for (const FinalAngleColumns& columns : final_angle_columns(names.outputs)) {
    stopped_.push_back({columns, Population(Grid{})});
    stopped_.back().angles.read(from);
  }
  for (std::size_t q = 0; q < required_.size(); ++q) {
    RequiredPopulation population{Population(Grid{})};
    population.values.read(from);
    get_count(from, population.worse);
    populations_.push_back(std::move(population));
  }
  for (auto& [failures, cut, open, absent, worst] : requirement_counts_) {
    get_count(from, failures);
    get_count(from, cut);
    get_count(from, open);
    get_count(from, absent);
    worst.read(from);
  }
  for (std::size_t i = 0; i < names.draws.size(); ++i) draw_scales_.push_back(get_scale(from));
  if (correlations_) correlations_->read(from);
  for (std::size_t left = from.get_count(2 * sizeof(std::uint64_t)); left > 0; --left) {
    std::string order = from.get_text();
    get_count(from, orders_[std::move(order)]);
  }
  get_count(from, other_orders_);
  for (std::size_t left = from.get_count(2 * sizeof(std::uint64_t)); left > 0; --left) {
    const auto status = static_cast<Status>(from.get<std::uint8_t>());
    ReasonCounts::Group reason;
    reason.pattern.words = get_texts(from);
    reason.pattern.numbers = get_texts(from);
    if (reason.pattern.numbers.size() + 1 != reason.pattern.words.size())
      throw from.broken("reasons");
    get_count(from, reason.count);
    reasons_.groups.emplace(std::pair(status, reason.pattern.words), std::move(reason));
  }
}

} // namespace wingspread
