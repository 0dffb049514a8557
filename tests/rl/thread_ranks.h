#pragma once

#include <barrier>
#include <exception>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "rl/communicator.h"

namespace simwright::rl {

// Ranks that are threads of one process.
class ThreadRanks {
 public:
  explicit ThreadRanks(int size)
      : barrier_(size), sums_(static_cast<std::size_t>(size)), texts_(sums_.size()) {}

  // Calls body(rank's communicator) on a thread for each rank, and waits. Rethrows an exception of
  // the lowest rank that threw.
  void Run(const std::function<void(Communicator*)>& body) {
    std::vector<std::exception_ptr> failures(texts_.size());
    {
      std::vector<std::jthread> threads;
      for (int rank = 0; rank < static_cast<int>(texts_.size()); ++rank) {
        threads.emplace_back([&, rank] {
          Rank one(this, rank);
          try {
            body(&one);
          } catch (...) {
            failures[static_cast<std::size_t>(rank)] = std::current_exception();
            barrier_.arrive_and_drop();
          }
        });
      }
    }
    for (const std::exception_ptr& failure : failures) {
      if (failure) std::rethrow_exception(failure);
    }
  }

 private:
  class Rank : public Communicator {
   public:
    Rank(ThreadRanks* all, int rank) : all_(*all), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(all_.texts_.size()); }
    void AllReduceSum(float* numbers, std::size_t count) override { Sum(numbers, count); }
    void AllReduceSum(double* numbers, std::size_t count) override { Sum(numbers, count); }
    std::vector<std::string> AllGather(std::string_view bytes) override {
      all_.texts_[static_cast<std::size_t>(rank_)] = bytes;
      all_.barrier_.arrive_and_wait();
      std::vector<std::string> texts = all_.texts_;
      all_.barrier_.arrive_and_wait();
      return texts;
    }
    std::string Broadcast(std::string_view bytes) override { return AllGather(bytes)[0]; }

   private:
    // Sums in the order of the ranks, on each.
    template <typename Number>
    void Sum(Number* numbers, std::size_t count) {
      all_.sums_[static_cast<std::size_t>(rank_)] = {numbers, numbers + count};
      all_.barrier_.arrive_and_wait();
      for (std::size_t i = 0; i < count; ++i) {
        numbers[i] = 0;
        for (const std::vector<double>& own : all_.sums_) {
          numbers[i] += static_cast<Number>(own.at(i));
        }
      }
      all_.barrier_.arrive_and_wait();
    }
    ThreadRanks& all_;
    int rank_;
  };

  std::barrier<> barrier_;
  std::vector<std::vector<double>> sums_;
  std::vector<std::string> texts_;
};

}  // namespace simwright::rl
