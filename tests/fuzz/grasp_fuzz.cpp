// Files of grasps from anywhere: core::Error, or grasps that are finite and can be written and read
// again; nothing else.
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "core/files.h"
#include "manipulation/grasp_file.h"
#include "tests/fuzz/temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace simwright;
  static const fuzz::TemporaryFile file("grasps.json");
  manipulation::GraspSet read;
  try {
    read = manipulation::ReadGraspSet(file.Write(data, size));
  } catch (const core::Error&) {
    return 0;
  }
  for (const manipulation::Grasp& grasp : read.grasps) {
    if (!grasp.object_from_tool.matrix().allFinite()) std::abort();
  }
  const std::string text = core::JsonText(manipulation::GraspSetJson(read));
  const manipulation::GraspSet again =
      manipulation::ReadGraspSet(file.Write(text.data(), text.size()));
  if (again.grasps.size() != read.grasps.size() || again.object != read.object) std::abort();
  return 0;
}
