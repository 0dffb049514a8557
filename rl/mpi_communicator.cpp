// The door of MPI. Without SIMWRIGHT_MPI only a single process can train.
#include "core/error.h"
#include "rl/communicator.h"

#ifdef SIMWRIGHT_MPI
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>
#endif

namespace simwright::rl {
namespace {

#ifdef SIMWRIGHT_MPI

int CountOf(std::size_t count) {
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw core::Error("a message between ranks has more than 2^31 elements", "MPI",
                      "train with fewer environments");
  }
  return static_cast<int>(count);
}

// Waits for a collective operation. The others may take minutes, in which rank 0 evaluates or a
// machine is slower: unlike MPI_Wait, this leaves the processor to them.
void Wait(MPI_Request request) {
  constexpr int kEager = 2000;
  constexpr std::chrono::microseconds kPause{50}, kLongPause{1000};
  constexpr int kShortPauses = 2000;
  for (int i = 0;; ++i) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    if (i < kEager) {
      std::this_thread::yield();
    } else {
      std::this_thread::sleep_for(i < kEager + kShortPauses ? kPause : kLongPause);
    }
  }
}

class MpiCommunicator : public Communicator {
 public:
  MpiCommunicator() {
    int level = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void AllReduceSum(float* numbers, std::size_t count) override {
    Reduce(numbers, count, MPI_FLOAT);
  }
  void AllReduceSum(double* numbers, std::size_t count) override {
    Reduce(numbers, count, MPI_DOUBLE);
  }
  std::vector<std::string> AllGather(std::string_view bytes) override {
    const int own = CountOf(bytes.size());
    std::vector<int> counts(static_cast<std::size_t>(size_)), begins(counts.size());
    MPI_Request request;
    MPI_Iallgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD, &request);
    Wait(request);
    std::size_t total = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      begins[i] = CountOf(total);
      total += static_cast<std::size_t>(counts[i]);
    }
    std::string all(static_cast<std::size_t>(CountOf(total)), '\0');
    MPI_Iallgatherv(bytes.data(), own, MPI_BYTE, all.data(), counts.data(), begins.data(), MPI_BYTE,
                    MPI_COMM_WORLD, &request);
    Wait(request);
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      parts.push_back(
          all.substr(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(counts[i])));
    }
    return parts;
  }
  std::string Broadcast(std::string_view bytes) override {
    int count = CountOf(bytes.size());
    MPI_Request request;
    MPI_Ibcast(&count, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
    Wait(request);
    std::string all =
        leads() ? std::string(bytes) : std::string(static_cast<std::size_t>(count), '\0');
    MPI_Ibcast(all.data(), count, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    Wait(request);
    return all;
  }
  void Finalize() override { MPI_Finalize(); }

 private:
  void Reduce(void* numbers, std::size_t count, MPI_Datatype type) {
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, numbers, CountOf(count), type, MPI_SUM, MPI_COMM_WORLD, &request);
    Wait(request);
  }

  int rank_ = 0, size_ = 1;
};

Communicator* JoinByMpi(const core::RankPlace& place) {
  static MpiCommunicator ranks;  // MPI starts once in a process
  if (ranks.size() == place.world_size && ranks.rank() == place.rank) return &ranks;
  throw core::Error("the launcher started " + std::to_string(place.world_size) +
                        " ranks, but MPI sees " + std::to_string(ranks.size()),
                    "MPI", "start them with mpirun of Open MPI, or with srun --mpi=pmix");
}

#else

Communicator* JoinByMpi(const core::RankPlace& place) {
  throw core::Error("this program was built without MPI, so " + std::to_string(place.world_size) +
                        " ranks cannot train together",
                    "train", "start one process, or build with libopenmpi-dev");
}

#endif

}  // namespace

Communicator* JoinRanks(const core::RankPlace& place) {
  return place.world_size == 1 ? SingleProcess() : JoinByMpi(place);
}

}  // namespace simwright::rl
