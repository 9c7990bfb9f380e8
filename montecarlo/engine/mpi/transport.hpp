/// Messages between the ranks of a job. Knows nothing of who carries them.
#pragma once

#include <optional>
#include <string>

namespace wingspread {

/// What a rank was sent.
struct Message {
  int from = 0;
  std::string bytes;
};

/// A rank's end of the transport. Messages from one rank to another arrive in the order in which they were sent. Of one
/// thread's use.
class Transport {
public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Which one this is: 0, 1, … size() − 1.
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// Sends it and does not wait until it has arrived.
  virtual void send(int to, std::string bytes) = 0;
  /// A message that has arrived; none when there is none now.
  [[nodiscard]] virtual std::optional<Message> receive() = 0;
};

} // namespace wingspread
