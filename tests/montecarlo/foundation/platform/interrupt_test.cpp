#include "montecarlo/foundation/platform/interrupt.hpp"

#include <catch2/catch.hpp>

#include <csignal>

using namespace wingspread;

namespace {

std::sig_atomic_t own_handler_called = 0;
void own_handler(int) { own_handler_called = 1; }

} // namespace

TEST_CASE("a signal raises the flag while there is an Interrupt, and not after") {
  std::signal(SIGINT, own_handler);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Interrupt interrupt;
    CHECK_FALSE(interrupt.flag());
    std::raise(signal);
    CHECK(interrupt.flag());
    CHECK(own_handler_called == 0);
  }
  std::raise(SIGINT);
  CHECK(own_handler_called == 1);
  std::signal(SIGINT, SIG_DFL);
}

TEST_CASE("nohup keeps its promise") {
  std::signal(SIGHUP, SIG_IGN);
  {
    const Interrupt interrupt;
    std::raise(SIGHUP);
    CHECK_FALSE(interrupt.flag());
  }
  std::signal(SIGHUP, SIG_DFL);
}
