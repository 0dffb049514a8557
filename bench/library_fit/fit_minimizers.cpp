// Compares minimizers of the library fit's loss: CMA-ES, and Ceres' BFGS with derivatives by
// central differences, with the same number of evaluations. Each starts from the best of 16
// proposals of the network for the true kind, on photos of instances of tuning seeds.
//   bench_fit_minimizers [--count N] [--evaluations N] [--weights FILE] [--threads N]
// --count: photos, each of another kind (default 20); --evaluations: per minimizer (420).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include "asset_lift/priors/shape_example.h"
#include "core/error.h"
#include "core/parallel.h"
#include "fit_case.h"
#include "library_fit/fit_search.h"
#include "library_fit/library_fit.h"
#include "workflows/priors/models_folder.h"

namespace simwright::bench {
namespace {

using Loss = std::function<double(const Eigen::VectorXd&)>;
using library_fit::FitKinds;
using library_fit::FitPoint;

constexpr int kPopulation = 14;  // of CMA-ES
constexpr std::uint64_t kFirstSeed = 2'000'000;

// The loss with derivatives by central differences, which all threads evaluate. Keeps the best
// point seen, and declines to evaluate more often than permitted, which ends the search.
class DifferencedLoss : public ceres::FirstOrderFunction {
 public:
  DifferencedLoss(int dimensions, double step, int evaluations, const Loss& loss)
      : dimensions_(dimensions), step_(step), left_(evaluations), loss_(loss) {}

  int NumParameters() const override { return dimensions_; }

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const Eigen::Map<const Eigen::VectorXd> x(parameters, dimensions_);
    const int points = gradient != nullptr ? 2 * dimensions_ + 1 : 1;
    left_ -= points;
    if (left_ < 0) return false;
    std::vector<double> losses(static_cast<size_t>(points));
    core::ParallelFor(points, [&](int i) {
      Eigen::VectorXd at = x;
      if (i > 0) at[(i - 1) / 2] += i % 2 == 1 ? step_ : -step_;
      losses[static_cast<size_t>(i)] = loss_(at);
    });
    *cost = losses[0];
    if (*cost < best_loss_) {
      best_loss_ = *cost;
      best_ = x;
    }
    for (int k = 0; gradient != nullptr && k < dimensions_; ++k) {
      const auto at = static_cast<size_t>(2 * k);
      gradient[k] = (losses[at + 1] - losses[at + 2]) / (2.0 * step_);
    }
    return true;
  }

  const Eigen::VectorXd& best() const { return best_; }

 private:
  int dimensions_;
  double step_;
  mutable int left_;
  const Loss& loss_;
  mutable double best_loss_ = 1e9;
  mutable Eigen::VectorXd best_;
};

// Returns the minimizer that differences over `step`, in the search's steps.
library_fit::FitMinimizer CeresMinimizer(double step, int evaluations) {
  return [=](int dimensions, const Loss& loss) -> Eigen::VectorXd {
    auto* function = new DifferencedLoss(dimensions, step, evaluations, loss);
    const ceres::GradientProblem problem(function);
    ceres::GradientProblemSolver::Options options;
    options.line_search_direction_type = ceres::BFGS;
    options.max_num_iterations = 1000;
    options.function_tolerance = 1e-7;
    options.logging_type = ceres::SILENT;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(dimensions);
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(options, problem, x.data(), &summary);
    return function->best();
  };
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

struct Column {
  std::string name;
  std::vector<double> losses;
  int best = 0;
};

struct Settings {
  int count = 20, evaluations = 420;
  std::filesystem::path weights = workflows::ModelsFolder() / "library_prior.pt";
};

Settings ReadSettings(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string flag = argv[i], value = argv[i + 1];
    if (flag == "--count")
      settings.count = std::stoi(value);
    else if (flag == "--evaluations")
      settings.evaluations = std::stoi(value);
    else if (flag == "--weights")
      settings.weights = value;
    else if (flag == "--threads")
      core::SetThreadCount(std::stoi(value));
    else
      throw core::Error("unknown option", flag);
  }
  return settings;
}

// Prints and adds the losses that each minimizer reaches on a photo of an instance.
void CompareOn(const library_fit::LibraryPrior& prior, int kind, std::uint64_t seed,
               int evaluations, std::vector<Column>* columns) {
  const library_fit::FitKind& of = FitKinds()[static_cast<size_t>(kind)];
  FitCase fit_case;
  fit_case.visual = library_fit::InstanceMesh(library_fit::SampleInstance(kind, seed));
  core::Rng rng = core::StreamRng(seed, 77);
  Photograph(ExampleBackgrounds(), of.articulated != nullptr, &rng, &fit_case);
  const library_fit::FitPhoto photo = library_fit::FitPhotoOf(fit_case.photo, fit_case.matte.alpha);
  const core::Image crop = asset_lift::CropImage(photo.photo, photo.alpha, photo.frame);
  const library_fit::FitTarget target = library_fit::MakeFitTarget(asset_lift::CropView(
      photo.photo, photo.alpha, photo.frame, library_fit::LibraryFitOptions().side));
  const auto prediction = prior.Predict(crop, {kind}).front();
  const library_fit::FitSearch search(prediction, target);
  std::vector<FitPoint> ends(columns->size(), search.Proposals(16, 1, &rng).front());
  search.Refine(evaluations / kPopulation, 0.5, &rng, &ends[1]);
  search.Refine(CeresMinimizer(0.02, evaluations), &ends[2]);
  search.Refine(CeresMinimizer(0.1, evaluations), &ends[3]);
  std::printf("%-24s", of.name.c_str());
  size_t best = 1;
  for (size_t k = 0; k < columns->size(); ++k) {
    (*columns)[k].losses.push_back(ends[k].loss);
    if (k > 0 && ends[k].loss < ends[best].loss) best = k;
    std::printf("  %s %.4f", (*columns)[k].name.c_str(), ends[k].loss);
  }
  ++(*columns)[best].best;
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int Main(int argc, char** argv) {
  const Settings settings = ReadSettings(argc, argv);
  const library_fit::LibraryPrior prior(settings.weights);
  std::vector<Column> columns = {
      {"start", {}, 0}, {"CMA-ES", {}, 0}, {"Ceres, step 0.02", {}, 0}, {"Ceres, step 0.1", {}, 0}};
  const int kinds = static_cast<int>(FitKinds().size());
  const int count = std::min(settings.count, kinds);
  for (int i = 0; i < count; ++i) {
    CompareOn(prior, i * kinds / count, kFirstSeed + static_cast<std::uint64_t>(i),
              settings.evaluations, &columns);
  }
  for (const Column& column : columns) {
    std::printf("%-18s median loss %.4f, lowest for %d of %zu\n", column.name.c_str(),
                Median(column.losses), column.best, column.losses.size());
  }
  return 0;
}

}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
