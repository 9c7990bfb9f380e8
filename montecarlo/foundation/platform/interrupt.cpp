#include "montecarlo/foundation/platform/interrupt.hpp"

#include "montecarlo/foundation/formats/files.hpp"

#include <cstring>
#include <unistd.h>

namespace wingspread {
namespace {

// A signal handler can reach nothing but globals, and may touch only lock-free ones.
std::atomic<bool> raised = false, is_last = false;
std::atomic<const char*> last_words = nullptr;
static_assert(std::atomic<bool>::is_always_lock_free &&
              std::atomic<const char*>::is_always_lock_free);

[[noreturn]] void end_now(const char* words) {
  drop_part();
  [[maybe_unused]] const auto written = write(STDERR_FILENO, words, std::strlen(words));
  _exit(interrupted_status);
}

} // namespace
} // namespace wingspread

extern "C" {
static void wingspread_raise(int signal) {
  using namespace wingspread;
  if (const char* words = last_words) end_now(words);
  if (raised.exchange(true))
    end_now("interrupted twice: what was under way is lost, what is in files is kept\n");
  is_last = signal != SIGINT;
}
}

namespace wingspread {
namespace {

void arm(int signal, struct sigaction* before) {
  struct sigaction raising {};
  raising.sa_handler = wingspread_raise;
  raising.sa_flags = SA_RESTART; // interrupted writes continue
  sigemptyset(&raising.sa_mask);
  sigaction(signal, &raising, before);
}

} // namespace

Interrupt::Interrupt() {
  raised = is_last = false;
  last_words = nullptr;
  arm(SIGINT, &before_int_);
  arm(SIGTERM, &before_term_);
  arm(SIGHUP, &before_hang_up_);
  if (before_hang_up_.sa_handler == SIG_IGN) sigaction(SIGHUP, &before_hang_up_, nullptr); // nohup
}

Interrupt::~Interrupt() {
  last_words = nullptr;
  sigaction(SIGINT, &before_int_, nullptr);
  sigaction(SIGTERM, &before_term_, nullptr);
  sigaction(SIGHUP, &before_hang_up_, nullptr);
}

const std::atomic<bool>& Interrupt::flag() const { return raised; }

bool Interrupt::is_urgent() const { return is_last; }

void Interrupt::end_at_once(const char* words) { last_words = words; }

} // namespace wingspread
