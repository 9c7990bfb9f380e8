#include "montecarlo/engine/mpi/mpi_transport.hpp"

#include <limits>
#include <list>
#include <mpi.h>
#include <utility>

namespace wingspread {
namespace {

/// Errors of MPI end the job: MPI's default handler (MPI_ERRORS_ARE_FATAL) stays.
class MpiTransport final : public Transport {
public:
  MpiTransport() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  /// Waits until everything was sent.
  ~MpiTransport() override {
    for (Sending& each : sending_) MPI_Wait(&each.request, MPI_STATUS_IGNORE);
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }

  void send(int to, std::string bytes) override {
    forget_sent();
    Sending& each = sending_.emplace_back();
    each.bytes = std::move(bytes);
    MPI_Isend(each.bytes.data(), static_cast<int>(each.bytes.size()), MPI_BYTE, to, tag,
              MPI_COMM_WORLD, &each.request);
  }

  [[nodiscard]] std::optional<Message> receive() override {
    forget_sent();
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
    if (!there) return std::nullopt;
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    Message message{status.MPI_SOURCE, std::string(static_cast<std::size_t>(bytes), '\0')};
    MPI_Recv(message.bytes.data(), bytes, MPI_BYTE, status.MPI_SOURCE, tag, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    return message;
  }

private:
  static constexpr int tag = 0;

  /// A message being sent; MPI needs its bytes in place until then.
  struct Sending {
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void forget_sent() {
    for (auto each = sending_.begin(); each != sending_.end();) {
      int sent = 0;
      MPI_Test(&each->request, &sent, MPI_STATUS_IGNORE);
      each = sent ? sending_.erase(each) : std::next(each);
    }
  }

  int rank_ = 0, size_ = 1;
  std::list<Sending> sending_;
};

} // namespace

std::unique_ptr<Transport> mpi_transport() { return std::make_unique<MpiTransport>(); }

} // namespace wingspread
