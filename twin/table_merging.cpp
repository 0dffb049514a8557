#include "twin/table_merging.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "twin/asset_retrieval.h"

namespace simwright::twin {
namespace {

constexpr double kMatchDistance = 0.03;  // m: beyond the errors, of objects that correspond
constexpr double kMatchDeviations = 3.0;
constexpr double kWidestLogScale = 0.5;     // between two reconstructions whose scale is unknown
constexpr double kNearestPair = 0.05;       // m between the objects of a pair
constexpr double kLeastMergedError = 1e-3;  // m, rad, and of logarithms
constexpr double kLeastConfidence = 0.25;   // of an object that the first photo does not show
constexpr double kSameKindBonus = 0.5;      // of a match, in matches
constexpr double kYawDisagreement = 0.5;    // rad

using Match = std::pair<int, int>;  // indices in the first and in the other reconstruction

double Square(double value) {
  return value * value;
}

Eigen::Vector2d PlaceOf(const ReconstructedObject& object) {
  return {object.fit.pose.x, object.fit.pose.y};
}

bool SameKind(const ReconstructedObject& a, const ReconstructedObject& b) {
  return a.retrieved >= 0 || b.retrieved >= 0 ? a.retrieved == b.retrieved
                                              : a.fit.instance.kind == b.fit.instance.kind;
}

double TurnInto(double angle) {
  return std::remainder(angle, 2.0 * M_PI);
}

// The least squares' similarity of points; its scale is 1 unless `free_scale`.
PlaneSimilarity FitSimilarity(const std::vector<Eigen::Vector2d>& to,
                              const std::vector<Eigen::Vector2d>& from, bool free_scale) {
  Eigen::Vector2d to_mean = Eigen::Vector2d::Zero(), from_mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < to.size(); ++i) {
    to_mean += to[i] / static_cast<double>(to.size());
    from_mean += from[i] / static_cast<double>(to.size());
  }
  double cosine = 0.0, sine = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Eigen::Vector2d a = from[i] - from_mean, b = to[i] - to_mean;
    cosine += a.dot(b);
    sine += a.x() * b.y() - a.y() * b.x();
    spread += a.squaredNorm();
  }
  PlaneSimilarity similarity;
  similarity.turn = std::atan2(sine, cosine);
  if (free_scale && spread > 0.0) {
    similarity.log_scale = std::log(std::max(1e-3, std::hypot(cosine, sine) / spread));
  }
  similarity.move = to_mean - similarity * from_mean;
  return similarity;
}

// One-to-one matches of objects that a similarity brings together, nearest first.
std::vector<Match> MatchesOf(const TableReconstruction& first, const TableReconstruction& other,
                             const PlaneSimilarity& similarity) {
  std::vector<std::pair<double, Match>> near;
  for (std::size_t k = 0; k < other.objects.size(); ++k) {
    const Eigen::Vector2d moved = similarity * PlaceOf(other.objects[k]);
    for (std::size_t i = 0; i < first.objects.size(); ++i) {
      const double distance = (moved - PlaceOf(first.objects[i])).norm();
      const double error =
          std::hypot(first.objects[i].position_error, other.objects[k].position_error);
      if (distance > kMatchDistance + kMatchDeviations * error) continue;
      near.push_back({distance, {static_cast<int>(i), static_cast<int>(k)}});
    }
  }
  std::sort(near.begin(), near.end());
  std::vector<bool> taken_first(first.objects.size()), taken_other(other.objects.size());
  std::vector<Match> matches;
  for (const auto& [distance, match] : near) {
    const auto i = static_cast<std::size_t>(match.first);
    const auto k = static_cast<std::size_t>(match.second);
    if (taken_first[i] || taken_other[k]) continue;
    taken_first[i] = taken_other[k] = true;
    matches.push_back(match);
  }
  return matches;
}

// The alignment of a reconstruction with the first.
class Alignment {
 public:
  Alignment(const TableReconstruction& first, const TableReconstruction& other)
      : first_(first),
        other_(other),
        free_scale_(first.log_scale_error > 0.0 || other.log_scale_error > 0.0) {
    const int of_first = static_cast<int>(first.objects.size());
    const int of_other = static_cast<int>(other.objects.size());
    for (int i = 0; i < of_first; ++i) {
      for (int j = 0; j < of_first; ++j) {
        for (int k = 0; k < of_other; ++k) {
          for (int l = 0; l < of_other; ++l) {
            if (i != j && k != l) Try({i, k}, {j, l});
          }
        }
      }
    }
    for (int step = 0; step < 3 && matches.size() >= 2; ++step) {
      similarity = Fit(matches);
      matches = MatchesOf(first_, other_, similarity);
    }
  }

  PlaneSimilarity similarity;
  std::vector<Match> matches;

 private:
  // Tries the similarity of two matches of like kinds.
  void Try(const Match& a, const Match& b) {
    if (!AreAlike(a) || !AreAlike(b)) return;
    const double to = (First(b) - First(a)).norm(), from = (Other(b) - Other(a)).norm();
    if (to < kNearestPair || from < kNearestPair) return;
    const double log_scale = std::log(to / from);
    const double widest = free_scale_ ? kWidestLogScale : kMatchDistance / std::min(to, from);
    if (std::abs(log_scale) > widest) return;
    const PlaneSimilarity tried = Fit({a, b});
    const std::vector<Match> found = MatchesOf(first_, other_, tried);
    double score = static_cast<double>(found.size());
    double off = 0.0;
    for (const Match& match : found) {
      if (AreAlike(match)) score += kSameKindBonus;
      off += (tried * Other(match) - First(match)).norm();
    }
    // Nearer places and scales decide between equal numbers.
    score -= std::min(0.4, off + 0.2 * std::abs(log_scale));
    if (score <= score_) return;
    score_ = score;
    similarity = tried;
    matches = found;
  }

  PlaneSimilarity Fit(const std::vector<Match>& of) const {
    std::vector<Eigen::Vector2d> to, from;
    for (const Match& match : of) {
      to.push_back(First(match));
      from.push_back(Other(match));
    }
    return FitSimilarity(to, from, free_scale_);
  }

  bool AreAlike(const Match& match) const {
    return SameKind(first_.objects[static_cast<std::size_t>(match.first)],
                    other_.objects[static_cast<std::size_t>(match.second)]);
  }
  Eigen::Vector2d First(const Match& match) const {
    return PlaceOf(first_.objects[static_cast<std::size_t>(match.first)]);
  }
  Eigen::Vector2d Other(const Match& match) const {
    return PlaceOf(other_.objects[static_cast<std::size_t>(match.second)]);
  }

  const TableReconstruction& first_;
  const TableReconstruction& other_;
  bool free_scale_;
  double score_ = 0.0;
};

// An object of a view, in the first one's frame and at the common scale.
struct View {
  int view = 0, object = 0;
  const ReconstructedObject* of = nullptr;
  std::string name;  // of its kind or asset
  Eigen::Vector2d place{0, 0};
  double yaw = 0.0, log_size = 0.0;  // of the factor of the size
  double log_scale_error = 0.0;      // of the view's reconstruction
};

View ViewOf(const std::vector<TableReconstruction>& views, const std::vector<TableAsset>& assets,
            int view, int object, const MergedTables& merged) {
  const PlaneSimilarity& to_first = merged.first_from_view[static_cast<std::size_t>(view)];
  View seen;
  seen.view = view;
  seen.object = object;
  seen.of = &views[static_cast<std::size_t>(view)].objects[static_cast<std::size_t>(object)];
  seen.name = NameOf(*seen.of, assets);
  seen.place = std::exp(merged.log_scale) * (to_first * PlaceOf(*seen.of));
  seen.yaw = seen.of->fit.pose.yaw + to_first.turn;
  seen.log_size = to_first.log_scale + merged.log_scale;
  seen.log_scale_error = views[static_cast<std::size_t>(view)].log_scale_error;
  return seen;
}

// Returns the view whose fit is taken: the most confident one of the kind with most confidence.
const View& Representative(const std::vector<View>& views) {
  const View* best = &views.front();
  double most = -1.0;
  for (const View& view : views) {
    double sum = 1e-3 * view.of->confidence;
    for (const View& other : views) {
      if (SameKind(*view.of, *other.of)) sum += other.of->confidence;
    }
    if (sum <= most) continue;
    most = sum;
    best = &view;
  }
  return *best;
}

MergedObject MergeViews(const std::vector<View>& views, double log_scale_error,
                        core::Findings* findings) {
  const View& taken = Representative(views);
  MergedObject merged;
  merged.view = taken.view;
  merged.object = taken.object;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double weights = 0.0, yaw = 0.0, yaw_weights = 0.0, doubt = 1.0;
  bool is_disputed = false;
  for (const View& view : views) {
    merged.seen_in.push_back(view.view);
    const double weight = 1.0 / Square(std::max(kLeastMergedError, view.of->position_error));
    place += weight * view.place;
    weights += weight;
    doubt *= 1.0 - view.of->confidence;
    is_disputed = is_disputed || !SameKind(*view.of, *taken.of);
    // A kind has a yaw of its own, and a round one any: only what agrees is averaged.
    const double off = TurnInto(view.yaw - taken.yaw);
    if (!SameKind(*view.of, *taken.of) || std::abs(off) > kYawDisagreement) continue;
    const double yaw_weight = 1.0 / Square(std::max(kLeastMergedError, view.of->yaw_error));
    yaw += yaw_weight * off;
    yaw_weights += yaw_weight;
  }
  place /= weights;
  merged.pose = {place.x(), place.y(), TurnInto(taken.yaw + yaw / yaw_weights)};
  merged.position_error = 1.0 / std::sqrt(weights);
  merged.yaw_error = 1.0 / std::sqrt(yaw_weights);
  merged.confidence = 1.0 - doubt;
  merged.size_factor = std::exp(taken.log_size);
  // The part of the error by the view's own scale becomes that by the common one.
  const double own = Square(taken.of->size_error) - Square(taken.log_scale_error);
  merged.size_error = std::hypot(std::sqrt(std::max(0.0, own)), log_scale_error);
  if (is_disputed) {
    std::string kinds;
    for (const View& view : views) {
      kinds +=
          (kinds.empty() ? "" : ", ") + view.name + " in photo " + std::to_string(view.view + 1);
    }
    findings->push_back({"twin-views-disagree", core::Severity::kWarning, taken.name,
                         "the photos disagree on an object: " + kinds, merged.confidence,
                         "--objects states its category"});
  }
  return merged;
}

// Averages what the reconstructions say of the scale, relative to the first one's.
void MergeScales(const std::vector<TableReconstruction>& views, MergedTables* merged) {
  double weights = 0.0, sum = 0.0;
  bool is_known = true;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const double error = std::max(kLeastMergedError, views[v].log_scale_error);
    is_known = is_known && views[v].log_scale_error <= 0.0;
    sum -= merged->first_from_view[v].log_scale / Square(error);
    weights += 1.0 / Square(error);
  }
  merged->log_scale = sum / weights;
  merged->log_scale_error = is_known ? 0.0 : 1.0 / std::sqrt(weights);
}

}  // namespace

Eigen::Vector2d PlaneSimilarity::operator*(const Eigen::Vector2d& point) const {
  return std::exp(log_scale) * (Eigen::Rotation2Dd(turn) * point) + move;
}

MergedTables MergeTables(const std::vector<TableReconstruction>& views,
                         const std::vector<TableAsset>& assets) {
  if (views.empty()) throw core::Error("there is no reconstruction to merge");
  MergedTables merged;
  merged.first_from_view.resize(views.size());
  std::vector<std::vector<Match>> matches(views.size());
  for (std::size_t v = 1; v < views.size(); ++v) {
    const Alignment alignment(views[0], views[v]);
    if (alignment.matches.size() < 2) {
      throw core::Error("fewer than two objects correspond to those of the first photo",
                        "photo " + std::to_string(v + 1),
                        "give photos of the same table that share at least two objects");
    }
    merged.first_from_view[v] = alignment.similarity;
    matches[v] = alignment.matches;
  }
  MergeScales(views, &merged);
  std::vector<std::vector<View>> groups(views[0].objects.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    groups[i].push_back(ViewOf(views, assets, 0, static_cast<int>(i), merged));
  }
  for (std::size_t v = 1; v < views.size(); ++v) {
    std::vector<int> group_of(views[v].objects.size(), -1);
    for (const auto& [first, other] : matches[v]) group_of[static_cast<std::size_t>(other)] = first;
    for (std::size_t k = 0; k < group_of.size(); ++k) {
      const View view = ViewOf(views, assets, static_cast<int>(v), static_cast<int>(k), merged);
      if (group_of[k] >= 0) {
        groups[static_cast<std::size_t>(group_of[k])].push_back(view);
        continue;
      }
      // An object that the first photo does not show may have been added by another one.
      auto known = groups.begin() + static_cast<std::ptrdiff_t>(views[0].objects.size());
      for (; known != groups.end(); ++known) {
        if (known->back().view == static_cast<int>(v)) continue;
        const double error = std::hypot(view.of->position_error, known->front().of->position_error);
        if ((known->front().place - view.place).norm() < kMatchDistance + error) break;
      }
      if (known != groups.end()) {
        known->push_back(view);
      } else if (view.of->confidence >= kLeastConfidence) {
        groups.push_back({view});
      } else {
        merged.findings.push_back(
            {"twin-views-disagree", core::Severity::kInfo, view.name,
             "photo " + std::to_string(v + 1) + " alone shows a doubtful object; it is left out",
             view.of->confidence, "--objects states its box"});
      }
    }
  }
  for (const std::vector<View>& group : groups) {
    merged.objects.push_back(MergeViews(group, merged.log_scale_error, &merged.findings));
  }
  return merged;
}

}  // namespace simwright::twin
