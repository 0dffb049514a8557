// Starts on instances of the library that leave the arm little room.
#include <gtest/gtest.h>

#include "core/files.h"
#include "manipulation/collision_checker.h"
#include "skills/skill_evaluation.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_suite.h"

namespace simwright::workflows {
namespace {

// The spout of faucet 50283 is an arch above its knobs, on which the wrist comes down where the
// faucet stands as described. The checker knows nothing of the plan that it judges.
TEST(SkillStarts, GraspKnobsUnderAnArchWithoutTouchingIt) {
  const core::TemporaryFolder folder;
  core::Progress progress(core::Progress::Style::kSilent);
  SkillRun run;
  run.folder = folder.path();
  run.set = tasks::ReadTaskFile(
      MakeCellTasks(CellOf("turn_faucet_knob"), 50283, 1, "", folder.path(), &progress));
  const auto skills = PrepareSkills(run);
  const skills::Skill& skill = *skills.front().evaluated;
  int free = 0;
  for (const skills::StartState& start : skills::SampleStarts(skill, 30, 5)) {
    const skills::SkillVariant& variant = skill.variants[static_cast<size_t>(start.variant)];
    const manipulation::CollisionChecker checker(skill, variant, start.state);
    free += checker.IsCollisionFree(start.grasp_configuration, manipulation::Fingers::kIgnored) &&
            start.grasp_configuration != skill.robot->home();
  }
  EXPECT_GE(free, 27);
}

}  // namespace
}  // namespace simwright::workflows
