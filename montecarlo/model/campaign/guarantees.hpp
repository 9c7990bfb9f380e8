/// Requirements and goals to stop at, from a campaign or from a file of their own.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// Refuses a part whose statistics hold for independent draws only, with a design whose draws depend on each other.
void refuse_dependent_draws(const JsonCursor& at, const char* what, DesignKind design);

/// Reads requirements and goals to stop at. Both name outputs of the campaign and need independent draws.
class GuaranteeReader {
public:
  /// @param scene null if the scene or the outputs have problems: then unknown outputs are not reported
  /// @param t_end end of the runs; nothing: limits on times are not checked
  GuaranteeReader(const Scene* scene, const Outputs& outputs, DesignKind design,
                  std::optional<double> t_end);
  void read(const JsonCursor& at, std::vector<Requirement>& requirements,
            Judged judged = Judged::no) const;
  /// @param requirements the campaign's; null if they have problems
  void read(const JsonCursor& at, const std::vector<Requirement>* requirements,
            StoppingRule& until) const;

private:
  const Scene* scene_;
  DesignKind design_;
  std::optional<double> t_end_;
  std::vector<std::string> names_, all_names_;
};
[[nodiscard]] GuaranteeReader guarantee_reader(const Campaign& campaign);

/// The key of a summary under which it has the requirements and statistics of the last `analyze`.
inline constexpr const char* analyzed_key = "analyzed";

/// The keys that lead to the requirements in a document for read_requirements_file; none if it is an array.
[[nodiscard]] std::vector<std::string> keys_of_requirements(const Json& document);

/// Reads requirements for this campaign from a file: an array, a campaign, or a summary.json
/// (the requirements of the last analysis, or else of the run).
/// @throws SpecError with all problems
[[nodiscard]] std::vector<Requirement> read_requirements_file(const std::filesystem::path& path,
                                                              const Campaign& campaign);

} // namespace wingspread
