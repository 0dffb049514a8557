#include "rl/running_moments.h"

namespace simwright::rl {

RunningMoments::RunningMoments(int size)
    : mean(Eigen::ArrayXd::Zero(size)), squares(Eigen::ArrayXd::Zero(size)) {}

void RunningMoments::Add(const Rows& rows) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(mean.size());
  double added = 0.0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (!rows.row(i).allFinite()) continue;
    sum += rows.row(i).transpose().array().cast<double>();
    added += 1.0;
  }
  if (added == 0.0) return;
  const Eigen::ArrayXd batch_mean = sum / added;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (!rows.row(i).allFinite()) continue;
    squares += (rows.row(i).transpose().array().cast<double>() - batch_mean).square();
  }
  const Eigen::ArrayXd apart = batch_mean - mean;
  const double total = count + added;
  squares += apart.square() * (count * added / total);
  mean += apart * (added / total);
  count = total;
}

Eigen::ArrayXd RunningMoments::Variance() const {
  if (count == 0.0) return Eigen::ArrayXd::Ones(mean.size());
  return squares / count;
}

}  // namespace simwright::rl
