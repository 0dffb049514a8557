#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "library_fit/fit_loss.h"
#include "library_fit/library_fit.h"

namespace simwright::library_fit {

// A point of the search: an instance and a view.
struct FitPoint {
  Instance instance;
  FitView view;
  FitAgreement agreement;
  double loss = 1e9;  // of the agreement, plus the improbability of the parameters
};

// Minimizes a loss over R^n from 0, in steps of about 1, and returns the best point. The loss may
// be called from several threads at once.
using FitMinimizer = std::function<Eigen::VectorXd(
    int dimensions, const std::function<double(const Eigen::VectorXd&)>& loss)>;

// The search for the instance of one kind that agrees best with a photo.
class FitSearch {
 public:
  FitSearch(const KindPrediction& prediction, const FitTarget& target);

  // Returns the loss of a point, and sets its agreement.
  double Evaluate(FitPoint* point) const;
  // Returns the `count` best of the network's proposals, the best first.
  std::vector<FitPoint> Proposals(int proposals, int count, core::Rng* rng) const;
  // Minimizes over view, size, opening and the choices on which the shape depends continuously: by
  // CMA-ES, or by another minimizer. The loss comes from renders: it has small steps, where pixels
  // change, and no derivatives.
  void Refine(int generations, double step, core::Rng* rng, FitPoint* point) const;
  void Refine(const FitMinimizer& minimizer, FitPoint* point) const;
  // Tries the values of each other choice in turn, and keeps what lowers the loss.
  void TryChoices(FitPoint* point) const;

 private:
  std::vector<int> ContinuousChoices(const FitPoint& point) const;
  double Improbability(const FitPoint& point) const;

  const KindPrediction& prediction_;
  size_t choices_ = 0;  // that the generator makes, at most; the network predicts more
  const FitTarget& target_;
};

}  // namespace simwright::library_fit
