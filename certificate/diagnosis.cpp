#include "certificate/diagnosis.h"

#include <algorithm>
#include <numeric>

namespace simwright::certificate {
namespace {

std::string ListOf(const std::vector<std::string>& names) {
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return list;
}

// Searches for the objects whose removal makes a target solvable.
class BlockerSearch {
 public:
  BlockerSearch(const Planner& planner, const PlacedScene& scene, const TargetTask& task,
                const CertificateOptions& options, Certificate* certificate)
      : planner_(planner),
        scene_(scene),
        task_(task),
        options_(options),
        certificate_(*certificate) {}

  void Run() {
    std::vector<int> others;
    for (size_t i = 0; i < scene_.bodies.size(); ++i) {
      const int body = static_cast<int>(i);
      if (!scene_.bodies[i].fixed && body != task_.target) others.push_back(body);
    }
    SearchCounts counts;
    if (others.empty()) {
      counts = certificate_.counts;
    } else if (HasPlan(others, &counts)) {
      FindBlockers(others);
      return;
    }
    if (counts.grasps == 0) {
      certificate_.verdict = Verdict::kNoGrasp;
      certificate_.reason =
          "no grasp: the object is wider than the gripper opens, or its sides are "
          "too steep to each other";
    } else if (counts.tried == 0) {
      certificate_.verdict = Verdict::kNoGrasp;
      certificate_.reason = "no collision-free grasp: furniture is in the way of the gripper";
    } else {
      certificate_.verdict = Verdict::kUnreachable;
      certificate_.reason = counts.unreachable == counts.tried
                                ? "unreachable: no grasp is within the arm's reach"
                                : "unreachable: furniture is in the way of the arm";
    }
  }

 private:
  // Returns true if there is a plan without the bodies `removed`.
  bool HasPlan(const std::vector<int>& removed, SearchCounts* counts = nullptr) {
    const PlacedScene fewer = scene_.Without(removed);
    TargetTask task = task_;
    task.target = TargetWithout(removed);
    ++certificate_.searches;
    MotionSearch search(planner_, fewer, task.target, *task.goal, task.world_from_robot,
                        options_.motion);
    const bool found = search.Next().has_value();
    if (counts != nullptr) *counts = search.counts();
    return found;
  }
  int TargetWithout(const std::vector<int>& removed) const {
    const auto before = std::count_if(removed.begin(), removed.end(),
                                      [&](int body) { return body < task_.target; });
    return task_.target - static_cast<int>(before);
  }
  bool IsProvedWithout(const std::vector<int>& removed) {
    TargetTask task = task_;
    task.target = TargetWithout(removed);
    const Certificate proved = CertifyTarget(planner_, scene_.Without(removed), task, options_, {});
    certificate_.searches += proved.searches;
    return proved.solvable();
  }

  // Takes `removed` as the blockers if the scene without them is certified. Keeps the first set
  // with a plan, in case that none is.
  bool Accept(const std::vector<int>& removed) {
    if (!HasPlan(removed)) return false;
    const bool proved = IsProvedWithout(removed);
    if (!proved && !certificate_.blockers.empty()) return false;
    certificate_.blockers.clear();
    for (const int body : removed) {
      certificate_.blockers.push_back(scene_.bodies[static_cast<size_t>(body)].name);
    }
    certificate_.blockers_verified = proved;
    return proved;
  }

  void FindBlockers(const std::vector<int>& others) {
    certificate_.verdict = Verdict::kBlocked;
    std::vector<int> suspects;  // by the number of rejections
    for (const int body : others) {
      if (HitsOf(body) > 0) suspects.push_back(body);
    }
    std::stable_sort(suspects.begin(), suspects.end(),
                     [&](int a, int b) { return HitsOf(a) > HitsOf(b); });
    if (!FindSingle(suspects) && !FindPair(suspects)) FindSet();
    if (certificate_.blockers.empty()) {
      certificate_.reason = "blocked by several objects";
    } else {
      certificate_.reason = "blocked by " + ListOf(certificate_.blockers);
    }
  }
  int HitsOf(int body) const { return certificate_.counts.hits[static_cast<size_t>(body)]; }

  // Returns the body that is still there with the most hits in a search without `removed` (sorted);
  // -1: none.
  int WorstOf(const SearchCounts& counts, const std::vector<int>& removed) const {
    int worst = -1, most = 0;
    for (size_t i = 0, left = 0; i < scene_.bodies.size(); ++i) {
      const int body = static_cast<int>(i);
      if (std::binary_search(removed.begin(), removed.end(), body)) continue;
      const int hits = counts.hits[left++];
      if (scene_.bodies[i].fixed || body == task_.target || hits <= most) continue;
      most = hits;
      worst = body;
    }
    return worst;
  }

  bool FindSingle(const std::vector<int>& suspects) {
    const size_t most = std::min(suspects.size(), static_cast<size_t>(options_.single_blockers));
    for (size_t i = 0; i < most; ++i) {
      if (Accept({suspects[i]})) return true;
    }
    return false;
  }
  bool FindPair(const std::vector<int>& suspects) {
    int left = options_.blocker_pairs;
    for (size_t b = 1; b < suspects.size(); ++b) {
      for (size_t a = 0; a < b; ++a) {
        if (left-- <= 0) return false;
        if (Accept({suspects[a], suspects[b]})) return true;
      }
    }
    return false;
  }
  // Removes the object with the most rejections until there is a plan, then gives back those that
  // are not in the way.
  bool FindSet() {
    std::vector<int> removed;
    SearchCounts counts = certificate_.counts;
    bool found = false;
    for (int i = 0; i < options_.most_removed && !found; ++i) {
      const int worst = WorstOf(counts, removed);
      if (worst < 0) return false;
      removed.insert(std::upper_bound(removed.begin(), removed.end(), worst), worst);
      found = HasPlan(removed, &counts);
    }
    if (!found) return false;
    for (size_t i = 0; i + 1 < removed.size();) {
      std::vector<int> fewer = removed;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      if (HasPlan(fewer)) {
        removed = fewer;
      } else {
        ++i;
      }
    }
    return Accept(removed);
  }

  const Planner& planner_;
  const PlacedScene& scene_;
  const TargetTask& task_;
  const CertificateOptions& options_;
  Certificate& certificate_;
};

}  // namespace

void Diagnose(const Planner& planner, const PlacedScene& scene, const TargetTask& task,
              const CertificateOptions& options, Certificate* certificate) {
  BlockerSearch(planner, scene, task, options, certificate).Run();
}

}  // namespace simwright::certificate
