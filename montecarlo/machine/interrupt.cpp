#include "montecarlo/machine/interrupt.hpp"

namespace wingspread {
namespace {

// A signal handler can reach nothing but globals, and may touch only lock-free ones.
std::atomic<bool> raised = false;
static_assert(std::atomic<bool>::is_always_lock_free);

} // namespace
} // namespace wingspread

extern "C" {
static void wingspread_raise(int) { wingspread::raised = true; }
}

namespace wingspread {

Interrupt::Interrupt() {
  raised = false;
  struct sigaction once {};
  once.sa_handler = wingspread_raise;
  once.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART); // SA_RESTART: writes go on
  sigemptyset(&once.sa_mask);
  sigaction(SIGINT, &once, &before_int_);
  sigaction(SIGTERM, &once, &before_term_);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &before_int_, nullptr);
  sigaction(SIGTERM, &before_term_, nullptr);
}

const std::atomic<bool>& Interrupt::flag() const { return raised; }

} // namespace wingspread
