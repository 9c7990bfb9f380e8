#include "tests/cli/program.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

extern char** environ;

namespace wingspread::test {

const char* const program_path = WINGSPREAD_BINARY;

namespace {

/// Starts the program with its two outputs into these files.
pid_t start(const std::vector<std::string>& arguments, const char* out, const char* error) {
  std::vector<std::string> words{program_path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY;
  posix_spawn_file_actions_addopen(&files, 1, out, flags, 0600);
  posix_spawn_file_actions_addopen(&files, 2, error, flags, 0600);
  pid_t process = 0;
  const int failed = posix_spawn(&process, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) throw std::runtime_error("the program cannot be started");
  return process;
}

} // namespace

Program::Program(const Folder& folder, const std::vector<std::string>& arguments,
                 const std::filesystem::path& out)
    : out_(out.empty() ? folder.path() / "stdout.txt" : out), error_(folder.path() / "stderr.txt"),
      process_(start(arguments, out_.c_str(), error_.c_str())) {}

void Program::send(int signal) const { kill(process_, signal); }

Finished Program::finish() const {
  int status = 0;
  waitpid(process_, &status, 0);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const bool is_file = std::filesystem::is_regular_file(out_);
  return {code, is_file ? read_text(out_).value() : "", read_text(error_).value()};
}

Finished run_program(const Folder& folder, const std::vector<std::string>& arguments,
                     const std::filesystem::path& out) {
  return Program(folder, arguments, out).finish();
}

std::vector<int> run_named(const Folder& folder, const std::string& text) {
  std::vector<int> codes;
  for (const std::string& line : lines_of(text)) {
    if (!line.starts_with("  wingspread ")) continue;
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; in >> word;) {
      std::erase(word, '\''); // of a path with a star
      words.push_back(word);
    }
    words.erase(words.begin());
    codes.push_back(run_program(folder, words).code);
  }
  return codes;
}

std::string shown_on_terminal(const std::vector<std::string>& arguments) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0)
    throw std::runtime_error("there is no terminal");
  const pid_t process = start(arguments, "/dev/null", ptsname(terminal));
  std::string shown;
  std::array<char, 4096> part{};
  for (ssize_t got = 0;
       (got = ::read(terminal, part.data(), part.size())) > 0;) // until it is closed
    shown.append(part.data(), static_cast<std::size_t>(got));
  ::close(terminal);
  waitpid(process, nullptr, 0);
  return shown;
}

Json page_data(const std::filesystem::path& page) {
  const std::string text = read_text(page).value();
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = text.find(begin) + begin.size();
  return parse_json(text.substr(from, text.find("</script>", from) - from));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

} // namespace wingspread::test
