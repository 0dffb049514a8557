#include "sim/mujoco_scene.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <optional>
#include <string_view>

#include <mujoco/mujoco.h>
#include <unistd.h>

#include "assets/mjcf_scene.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::sim {
namespace fs = std::filesystem;
namespace {

// MuJoCo reports warnings through one global callback; they go to the world whose call is running.
thread_local std::vector<std::string>* active_warnings = nullptr;

void AppendWarning(const char* text) {
  if (active_warnings != nullptr) active_warnings->push_back(text);
}

class WarningScope {
 public:
  explicit WarningScope(std::vector<std::string>* messages) {
    mju_user_warning = AppendWarning;
    active_warnings = messages;
  }
  ~WarningScope() { active_warnings = nullptr; }
};

// Includes the asset in a scene with a floor. A temporary file, since MuJoCo 2.2 reads files.
class SceneFile {
 public:
  SceneFile(const fs::path& mjcf, const std::vector<double>& balls, const std::string& elements) {
    const fs::path folder = fs::absolute(mjcf).parent_path();
    const std::string model = core::ReadFile(mjcf);
    int geoms = 0;
    for (size_t at = model.find("<geom"); at != std::string::npos;
         at = model.find("<geom", at + 1)) {
      ++geoms;
    }
    std::string pattern = (fs::temp_directory_path() / "simwright_scene_XXXXXX.xml").string();
    const int file = mkstemps(pattern.data(), 4);
    if (file < 0) throw core::Error("cannot write a temporary file", pattern);
    close(file);
    path_ = pattern;
    std::ofstream out(path_);
    out << "<mujoco><compiler angle=\"radian\" meshdir=\"" << folder.string() << "\" texturedir=\""
        << folder.string()
        << "\"/><include file=\""
        // MuJoCo 2.2 prepends the scene's folder to any include, even to an absolute one.
        << fs::relative(fs::canonical(mjcf), fs::canonical(path_.parent_path())).string() << "\"/>";
    // A model with its own <option> and <size> keeps them.
    if (model.find("<size") == std::string::npos) out << assets::MjcfPhysicsText(geoms);
    out << "<worldbody>" << assets::MjcfGroundText();
    for (size_t i = 0; i < balls.size(); ++i) {
      out << "<body name=\"ball_" << i << "\"><freejoint/><geom type=\"sphere\" size=\"" << balls[i]
          << "\" condim=\"4\" solref=\"0.005 1\"/></body>";
    }
    out << "</worldbody>" << elements << "</mujoco>\n";
  }
  ~SceneFile() {
    std::error_code code;
    fs::remove(path_, code);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Returns the error of a file that MuJoCo cannot load, in one line.
core::Error LoadingError(std::string message, const std::string& file) {
  constexpr std::string_view kLine = "Line number=";
  const size_t line = message.find(kLine);
  if (message.find("XML parse error") != std::string::npos && line != std::string::npos) {
    const int number = std::atoi(message.c_str() + line + kLine.size());
    return core::Error("is not whole XML: line " + std::to_string(number), file,
                       "it was cut off or edited: make it again, or correct it there");
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  message.erase(message.find_last_not_of(' ') + 1);
  return core::Error(message, file);
}

}  // namespace

MujocoScene::MujocoScene(const fs::path& mjcf, const std::vector<double>& balls, Ground ground,
                         const std::string& elements) {
  if (!fs::exists(mjcf)) throw core::Error("no such file", mjcf.string());
  std::optional<SceneFile> scene;
  if (ground == Ground::kAdded) scene.emplace(mjcf, balls, elements);
  const fs::path& file = scene ? scene->path() : mjcf;
  char message[1000] = "";
  {
    // The XML compiler keeps global state (locale, last model).
    static std::mutex compiler_mutex;
    const std::lock_guard lock(compiler_mutex);
    const WarningScope scope(&warnings_);
    model_ = mj_loadXML(file.c_str(), nullptr, message, sizeof(message));
  }
  if (model_ == nullptr) throw LoadingError(message, mjcf.string());
  if (message[0] != '\0') warnings_.emplace_back(message);
  data_ = mj_makeData(model_);
}

MujocoScene::~MujocoScene() {
  if (data_ != nullptr) mj_deleteData(data_);
  if (model_ != nullptr) mj_deleteModel(model_);
}

void MujocoScene::Step() {
  const WarningScope scope(&warnings_);
  mj_step(model_, data_);
}

}  // namespace simwright::sim
