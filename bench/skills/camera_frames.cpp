// Measures frames per second of the cameras of skill worlds, while the scripted expert does the
// first subtask of a task: poses are set and 128 x 128 pixels of the default cameras are rendered.
//   build/bin/simwright library --kind microwave,cup,drawer_unit --count 1 -o out/kitchen
//   build/bin/simwright tasks out/kitchen -o out/tasks.json
//   build/bin/bench_camera_frames out/tasks.json put_cup_1_into_microwave_1_and_close_it
// With a third argument, writes pictures of the cameras into that folder instead; a fourth one,
// "wide", randomises their looks.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/image.h"
#include "core/parallel.h"
#include "robot/panda_model.h"
#include "skills/episode.h"
#include "skills/episode_cameras.h"
#include "skills/scripted_expert.h"
#include "tasks/task_file.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

std::shared_ptr<const skills::Skill> FirstSkill(const tasks::TaskSet& set,
                                                const std::string& name) {
  for (const tasks::Task& task : set.tasks) {
    if (task.name != name) continue;
    skills::SkillSubtask first;
    first.subtask = task.subtasks.front();
    for (const tasks::TaskAsset& asset : set.assets) {
      if (std::find(task.assets.begin(), task.assets.end(), asset.name) == task.assets.end()) {
        continue;
      }
      first.assets.push_back(assets::ReadSemanticModel(asset.path));
      first.assets.back().name = asset.name;
    }
    return skills::MakeSkill(robot::Panda(false), {first}, skills::SkillOptions().ForEvaluation());
  }
  throw core::Error("there is no task '" + name + "'");
}

struct Moment {
  tasks::WorldState state;
  Eigen::VectorXd arm;
  double leader = 0.0;
};

// Returns the states of an episode of the scripted expert, one per decision.
std::vector<Moment> ExpertMoments(const skills::Skill& skill) {
  skills::Episode episode(skill);
  core::Rng rng = core::StreamRng(3, 0);
  episode.Begin(skills::SampleStart(skill, rng));
  std::vector<float> action(static_cast<std::size_t>(skills::ActionSize(skill)));
  std::vector<Moment> moments;
  for (skills::Decision decision; !decision.terminated && !decision.truncated;) {
    skills::ExpertAction(episode, action.data());
    decision = episode.Step(action.data());
    Moment& moment = moments.emplace_back();
    moment.state = episode.state();
    episode.world().robot().Positions(&moment.arm);
    moment.leader = episode.world().robot().Leader();
  }
  return moments;
}

// Memory of N images.
struct Images {
  Images(std::size_t count, const render::CameraSpec& camera)
      : pixels(static_cast<std::size_t>(camera.width * camera.height)),
        rgb(3 * count * pixels),
        depth(count * pixels),
        normal(3 * count * pixels),
        label(count * pixels) {}

  render::ImageBuffers At(std::size_t i) {
    return {&rgb[3 * i * pixels], &depth[i * pixels], &label[i * pixels], &normal[3 * i * pixels]};
  }

  std::size_t pixels;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth, normal;
  std::vector<std::int32_t> label;
};

struct Setting {
  const char* name;
  bool rgb, depth, label, normal;
};

double FramesPerSecond(std::vector<skills::EpisodeView>* views, const std::vector<Moment>& moments,
                       const Setting& setting, Images* images) {
  std::vector<const skills::EpisodeView*> seen;
  for (const skills::EpisodeView& view : *views) seen.push_back(&view);
  const auto cameras = static_cast<std::size_t>(views->front().cameras().size());
  std::vector<render::ImageBuffers> buffers;
  for (std::size_t i = 0; i < cameras * views->size(); ++i) {
    render::ImageBuffers image = images->At(i);
    if (!setting.rgb) image.rgb = nullptr;
    if (!setting.depth) image.depth = nullptr;
    if (!setting.label) image.label = nullptr;
    if (!setting.normal) image.normal = nullptr;
    buffers.push_back(image);
  }
  double best = 0.0;
  for (int repetition = 0; repetition < 24; ++repetition) {
    const auto start = Clock::now();
    std::size_t frames = 0, moment = 0;
    for (; frames < 64; frames += buffers.size()) {
      for (skills::EpisodeView& view : *views) {
        const Moment& now = moments[moment++ % moments.size()];
        view.Pose(now.state, now.arm, now.leader);
      }
      skills::RenderViews(seen, buffers);
    }
    const std::chrono::duration<double> seconds = Clock::now() - start;
    best = std::max(best, static_cast<double>(frames) / seconds.count());
  }
  return best;
}

void PrintFrames(const std::shared_ptr<const skills::Skill>& skill) {
  const std::vector<Moment> moments = ExpertMoments(*skill);
  std::printf("%-30s %10s %12s %12s\n", "buffers", "samples", "1 thread", "2 threads");
  for (const int samples : {1, 2}) {
    skills::EpisodeCamerasOptions options;
    options.samples_per_side = samples;
    for (const std::string name : {"front", "wrist"}) {
      std::vector<render::CameraSpec> specs = skills::DefaultCameras();
      std::erase_if(specs, [&](const render::CameraSpec& spec) { return spec.name != name; });
      const auto cameras = std::make_shared<skills::EpisodeCameras>(skill, specs, options);
      std::vector<skills::EpisodeView> views(16, skills::EpisodeView(cameras));
      if (samples == 1 && name == "front") {
        int triangles = 0;
        for (int p = 0; p < views[0].scene().size(); ++p) {
          triangles += views[0].scene().part(p).mesh->triangle_count();
        }
        std::printf("%d parts, %d triangles, %zu moments\n", views[0].scene().size(), triangles,
                    moments.size());
      }
      Images images(views.size(), specs.front());
      for (const Setting& setting : {Setting{"rgb", true, false, false, false},
                                     Setting{"rgb, depth, labels", true, true, true, false},
                                     Setting{"all four", true, true, true, true},
                                     Setting{"depth, labels", false, true, true, false}}) {
        if (samples > 1 && setting.normal) continue;
        double rates[2];
        for (const int threads : {1, 2}) {
          core::SetThreadCount(threads);
          rates[threads - 1] = FramesPerSecond(&views, moments, setting, &images);
        }
        std::printf("%-30s %10d %12.0f %12.0f\n", (name + ": " + setting.name).c_str(), samples,
                    rates[0], rates[1]);
      }
    }
  }
}

void WritePictures(const std::shared_ptr<const skills::Skill>& skill,
                   const std::filesystem::path& folder, bool wide) {
  std::filesystem::create_directories(folder);
  skills::EpisodeCamerasOptions options;
  if (wide) options.look = render::LookRanges::Wide();
  const auto cameras =
      std::make_shared<skills::EpisodeCameras>(skill, skills::DefaultCameras(256, 256), options);
  skills::EpisodeView view(cameras);
  const std::vector<Moment> moments = ExpertMoments(*skill);
  Images images(1, cameras->cameras().front());
  std::vector<core::Image> pictures;
  for (int frame = 0; frame < 4; ++frame) {
    if (wide) view.Begin(0, static_cast<std::uint64_t>(frame));
    const Moment& now = moments[(moments.size() - 1) * static_cast<std::size_t>(frame) / 3];
    view.Pose(now.state, now.arm, now.leader);
    for (int camera = 0; camera < cameras->size(); ++camera) {
      view.Render(camera, images.At(0));
      core::Image color(256, 256, 3), label(256, 256, 3), depth(256, 256, 3);
      color.pixels = images.rgb;
      for (std::size_t i = 0; i < images.pixels; ++i) {
        const auto hash = static_cast<std::uint32_t>(images.label[i] + 2) * 2654435761u;
        for (std::size_t c = 0; c < 3; ++c) {
          label.pixels[3 * i + c] = static_cast<std::uint8_t>(hash >> (8 * c + 4));
          depth.pixels[3 * i + c] =
              static_cast<std::uint8_t>(std::min(255.0f, 110.0f * images.depth[i]));
        }
      }
      pictures.insert(pictures.end(), {color, label});
      if (camera == 0 && frame == 0) core::WritePng(folder / "depth.png", depth);
    }
  }
  core::WritePng(folder / "cameras.png", core::ContactSheet(pictures, 4));
  for (const skills::LabelName& entry : cameras->Legend(0)) {
    std::printf("%3d %s%s\n", entry.label, entry.name.c_str(), entry.is_target ? " (target)" : "");
  }
}

}  // namespace
}  // namespace simwright

int main(int count, char** words) {
  using namespace simwright;
  if (count < 3) {
    std::fprintf(stderr, "usage: bench_camera_frames TASKS.json TASK [FOLDER [wide]]\n");
    return 2;
  }
  try {
    const auto skill = FirstSkill(tasks::ReadTaskFile(words[1]), words[2]);
    if (count > 3) {
      WritePictures(skill, words[3], count > 4);
    } else {
      PrintFrames(skill);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
