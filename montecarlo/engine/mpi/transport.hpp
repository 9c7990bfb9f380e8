/// The transport between ranks: asynchronous messages of bytes.
#pragma once

#include <optional>
#include <string>

namespace wingspread {

/// A received message.
struct Message {
  int from = 0;
  std::string bytes;
};

/// A rank's connection to the others. Messages from one rank to another arrive in the order sent. For one thread
/// only.
class Transport {
public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// This rank: 0, 1, … size() − 1.
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// Sends without waiting for arrival.
  virtual void send(int to, std::string bytes) = 0;
  /// A message that has arrived; nothing if there is none now.
  [[nodiscard]] virtual std::optional<Message> receive() = 0;
};

} // namespace wingspread
