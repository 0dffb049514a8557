#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/ranks.h"

namespace simwright::rl {

// Communication among the ranks of a training, which all call the same members in the same order.
// The results of a member are bit-identical on all ranks.
class Communicator {
 public:
  virtual ~Communicator() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  bool leads() const { return rank() == 0; }

  // Replace `numbers` (count) by their sums over all ranks.
  virtual void AllReduceSum(float* numbers, std::size_t count) = 0;
  virtual void AllReduceSum(double* numbers, std::size_t count) = 0;
  // Returns what each rank passes, by rank.
  virtual std::vector<std::string> AllGather(std::string_view bytes) = 0;
  // Returns what rank 0 passes.
  virtual std::string Broadcast(std::string_view bytes) = 0;

  // Ends the communication, after the work of all ranks. Without it, as after an error, the end of
  // this process makes the launcher end the other ranks.
  virtual void Finalize() {}

  // Returns the sum of one number over all ranks.
  double Sum(double number) {
    AllReduceSum(&number, 1);
    return number;
  }
};

// Returns the communicator of a process that trains alone, of size 1. It has no state.
Communicator* SingleProcess();

// Joins the ranks that a launcher started: by MPI, or SingleProcess where there are no others. What
// it returns lives as long as the program. Throws core::Error if this program was built without
// MPI, or if MPI counts other ranks than `place`.
Communicator* JoinRanks(const core::RankPlace& place);

}  // namespace simwright::rl
