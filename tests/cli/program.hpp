/// Runs the program as a user does, and keeps its output.
#pragma once

#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <sys/types.h>

#include <string>
#include <vector>

namespace wingspread::test {

/// The absolute path of the program under test.
extern const char* const program_path;

/// The exit status and outputs of a finished program.
struct Finished {
  int code; ///< exit status; 128 + N when signal N ended it
  std::string out, error;
};

/// The program, started with these arguments, its two outputs into files of the folder.
class Program {
public:
  /// @param out where its standard output goes, if not into the folder
  Program(const Folder& folder, const std::vector<std::string>& arguments,
          const std::filesystem::path& out = {});
  void send(int signal) const;
  [[nodiscard]] Finished finish() const;

private:
  std::filesystem::path out_, error_;
  pid_t process_ = 0;
};

/// Starts it and waits for its end.
[[nodiscard]] Finished run_program(const Folder& folder, const std::vector<std::string>& arguments,
                                   const std::filesystem::path& out = {});

/// Runs the commands that the program printed, one per line. @return their exit codes
[[nodiscard]] std::vector<int> run_named(const Folder& folder, const std::string& text);

/// What the program writes to standard error where that is a terminal.
[[nodiscard]] std::string shown_on_terminal(const std::vector<std::string>& arguments);

/// Matches a text that has all of these facts, in this order. The words around them may change.
class HasFacts final : public Catch::MatcherBase<std::string> {
public:
  HasFacts(std::initializer_list<std::string> facts) : facts_(facts) {}
  [[nodiscard]] bool match(const std::string& text) const override {
    std::size_t at = 0;
    for (const std::string& fact : facts_) {
      at = text.find(fact, at);
      if (at == std::string::npos) return false;
      at += fact.size();
    }
    return true;
  }
  [[nodiscard]] std::string describe() const override {
    std::string text = "has in this order:";
    for (const std::string& fact : facts_) text += " \"" + fact + '"';
    return text;
  }

private:
  std::vector<std::string> facts_;
};

/// A finished campaign in a folder.
struct DoneCampaign {
  Folder folder{};
  std::filesystem::path path = folder.path() / "r";
  explicit DoneCampaign(const Json& json) { (void)run_into(path, campaign_of(json)); }

  [[nodiscard]] Finished program(const std::vector<std::string>& arguments) const {
    return run_program(folder, arguments);
  }
};

/// The block of data of a page that `report` wrote.
[[nodiscard]] Json page_data(const std::filesystem::path& page);

/// Lines of a text.
[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

} // namespace wingspread::test
