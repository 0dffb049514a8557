#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/files.h"
#include "transfer/twin_tasks.h"
#include "workflows/twin/twin_record.h"

namespace simwright::transfer {

// Returns the URDF of a block of `side` x `side` x 8 cm that stands on z = 0 and weighs 0.2 kg.
inline std::string BlockUrdf(double side) {
  const std::string size = std::to_string(side) + " " + std::to_string(side) + " 0.08";
  const double across = 0.2 * (side * side + 0.0064) / 12.0, up = 0.2 * side * side / 6.0;
  return "<robot name=\"block\"><link name=\"base\">"
         "<visual><origin xyz=\"0 0 0.04\"/><geometry><box size=\"" +
         size +
         "\"/></geometry></visual>"
         "<collision><origin xyz=\"0 0 0.04\"/><geometry><box size=\"" +
         size +
         "\"/></geometry></collision>"
         "<inertial><origin xyz=\"0 0 0.04\"/><mass value=\"0.2\"/><inertia ixx=\"" +
         std::to_string(across) + "\" iyy=\"" + std::to_string(across) + "\" izz=\"" +
         std::to_string(up) + "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link></robot>\n";
}

struct PlacedBlock {
  double x, y, yaw;
  double side = 0.05;
};

// Writes a twin of blocks, "block_1" on, below `folder`. Their errors: `position` m, 0.05 rad and
// `size` of the logarithm.
inline workflows::TwinRecord WriteBlockTwin(const std::filesystem::path& folder,
                                            const std::vector<PlacedBlock>& blocks,
                                            double position = 0.004, double size = 0.02) {
  workflows::TwinRecord record;
  record.photo = "table.jpg";
  record.camera.width = 320;
  record.camera.height = 240;
  record.camera.fx = record.camera.fy = 300.0;
  record.camera.cx = 160.0;
  record.camera.cy = 120.0;
  record.stands = true;
  for (const PlacedBlock& block : blocks) {
    workflows::TwinObject object;
    object.name = "block_" + std::to_string(record.objects.size() + 1);
    object.kind = object.category = "box";
    object.world_from_object.linear() =
        Eigen::AngleAxisd(block.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    object.world_from_object.translation() = Eigen::Vector3d(block.x, block.y, 0.0);
    object.size = {block.side, block.side, 0.08};
    object.confidence = object.outline_iou = 0.9;
    object.position_error = position;
    object.yaw_error = 0.05;
    object.size_error = size;
    object.box = {Eigen::Vector2d(10, 20), Eigen::Vector2d(60, 70)};
    const std::filesystem::path asset = folder / "assets" / object.name;
    std::filesystem::create_directories(asset);
    core::WriteFile(asset / (object.name + ".urdf"), BlockUrdf(block.side));
    record.objects.push_back(object);
  }
  core::WriteFile(folder / "twin.json", workflows::TwinJson(record));
  return record;
}

// Returns the tasks of a twin, written as `folder`/tasks.json.
inline workflows::TasksReport BlockTasks(const std::filesystem::path& folder) {
  TwinTasksRequest request;
  request.twin = folder;
  request.output = folder / "tasks.json";
  request.count = 20;
  request.force = true;
  core::Progress silent;
  return MakeTwinTasks(request, &silent);
}

}  // namespace simwright::transfer
