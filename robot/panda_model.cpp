#include "robot/panda_model.h"

#include <string>
#include <string_view>

#include "core/files.h"

namespace simwright::robot {
namespace data {

std::string_view panda_urdf();
std::string_view panda_json();
std::string_view panda_on_base_urdf();
std::string_view panda_on_base_json();

}  // namespace data
namespace {

// Writes the embedded files to a temporary folder, so that they are read and checked like any other
// robot.
RobotModel ReadEmbedded(const std::string& name, std::string_view urdf, std::string_view side) {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / (name + ".urdf"), urdf);
  core::WriteFile(folder.path() / (name + ".json"), side);
  RobotModel model = ReadRobot(folder.path() / (name + ".urdf"));
  for (core::Finding& finding : model.urdf.findings) finding.place = name + ".urdf";
  return model;
}

}  // namespace

const RobotModel& Panda(bool on_base) {
  if (on_base) {
    static const RobotModel* model = new RobotModel(
        ReadEmbedded("panda_on_base", data::panda_on_base_urdf(), data::panda_on_base_json()));
    return *model;
  }
  static const RobotModel* model =
      new RobotModel(ReadEmbedded("panda", data::panda_urdf(), data::panda_json()));
  return *model;
}

}  // namespace simwright::robot
