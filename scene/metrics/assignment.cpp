#include "scene/metrics/assignment.h"

#include <limits>

#include "core/error.h"

namespace simwright::scene {
namespace {

// Requires rows <= columns. Index 0 of the arrays means none.
class Augmentation {
 public:
  explicit Augmentation(const Eigen::MatrixXd& cost)
      : cost_(cost),
        row_price_(static_cast<size_t>(cost.rows()) + 1, 0.0),
        column_price_(static_cast<size_t>(cost.cols()) + 1, 0.0),
        row_of_(column_price_.size(), 0),
        before_(column_price_.size(), 0) {}

  void AddRow(size_t row) {
    row_of_[0] = row;
    size_t column = 0;
    std::vector<double> least(column_price_.size(), std::numeric_limits<double>::infinity());
    std::vector<char> used(column_price_.size(), 0);
    do {
      used[column] = 1;
      column = NextColumn(column, &least, &used);
    } while (row_of_[column] != 0);
    while (column != 0) {
      row_of_[column] = row_of_[before_[column]];
      column = before_[column];
    }
  }

  const std::vector<size_t>& row_of() const { return row_of_; }

 private:
  // Performs one step of Dijkstra's search over reduced costs.
  size_t NextColumn(size_t column, std::vector<double>* least, std::vector<char>* used) {
    const size_t row = row_of_[column];
    double step = std::numeric_limits<double>::infinity();
    size_t next = 0;
    for (size_t j = 1; j < column_price_.size(); ++j) {
      if ((*used)[j]) continue;
      const double reduced =
          cost_(static_cast<Eigen::Index>(row) - 1, static_cast<Eigen::Index>(j) - 1) -
          row_price_[row] - column_price_[j];
      if (reduced < (*least)[j]) (*least)[j] = reduced, before_[j] = column;
      if ((*least)[j] < step) step = (*least)[j], next = j;
    }
    for (size_t j = 0; j < column_price_.size(); ++j) {
      if ((*used)[j]) {
        row_price_[row_of_[j]] += step;
        column_price_[j] -= step;
      } else {
        (*least)[j] -= step;
      }
    }
    return next;
  }

  const Eigen::MatrixXd& cost_;
  std::vector<double> row_price_, column_price_;
  std::vector<size_t> row_of_, before_;
};

}  // namespace

Assignment CheapestAssignment(const Eigen::MatrixXd& cost) {
  if (!cost.allFinite()) throw core::Error("an assignment needs finite costs");
  const bool transposed = cost.rows() > cost.cols();
  const Eigen::MatrixXd wide = transposed ? Eigen::MatrixXd(cost.transpose()) : cost;
  Augmentation augmentation(wide);
  for (size_t row = 1; row <= static_cast<size_t>(wide.rows()); ++row) augmentation.AddRow(row);
  Assignment assignment;
  assignment.column.assign(static_cast<size_t>(cost.rows()), -1);
  const std::vector<size_t>& row_of = augmentation.row_of();
  for (size_t j = 1; j < row_of.size(); ++j) {
    if (row_of[j] == 0) continue;
    const int i = static_cast<int>(row_of[j]) - 1, k = static_cast<int>(j) - 1;
    assignment.cost += wide(i, k);
    if (transposed) {
      assignment.column[static_cast<size_t>(k)] = i;
    } else {
      assignment.column[static_cast<size_t>(i)] = k;
    }
  }
  return assignment;
}

}  // namespace simwright::scene
