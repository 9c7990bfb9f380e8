#include "tests/cli/program.hpp"

#include <sys/wait.h>

#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>

extern char** environ;

namespace wingspread::test {

const char* const program_path = WINGSPREAD_BINARY;

Program::Program(const Folder& folder, const std::vector<std::string>& arguments,
                 const std::filesystem::path& out)
    : out_(out.empty() ? folder.path() / "stdout.txt" : out), error_(folder.path() / "stderr.txt") {
  std::vector<std::string> words{program_path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&files, 1, out_.c_str(), flags, 0600);
  posix_spawn_file_actions_addopen(&files, 2, error_.c_str(), flags, 0600);
  const int failed = posix_spawn(&process_, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) throw std::runtime_error("the program cannot be started");
}

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
