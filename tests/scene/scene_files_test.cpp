// Exported scenes as JSON and as Drake directives, which Python reads.
#include "scene/export/scene_files.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "scene/export/placed_objects.h"

namespace simwright::scene {
namespace {

// Reads both files and compares each pose of the directives with that of the JSON, converted to
// matrices by Rodrigues' formula and by quaternions, with any parser of the numbers.
constexpr char kScript[] = R"(
import json, math, sys, yaml
class AngleAxis(dict): pass
class Loader(yaml.SafeLoader): pass
Loader.add_constructor('!AngleAxis', lambda l, n: AngleAxis(l.construct_mapping(n, deep=True)))
scene = json.load(open(sys.argv[1]))
directives = yaml.load(open(sys.argv[2]), Loader)['directives']

def turn_of_quaternion(w, x, y, z):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]

def turn_of(rotation):
    assert isinstance(rotation, AngleAxis), rotation
    assert isinstance(rotation['angle_deg'], float), rotation
    a, k = math.radians(rotation['angle_deg']), rotation['axis']
    assert abs(math.hypot(*k) - 1) < 1e-12
    c, s = math.cos(a), math.sin(a)
    cross = [[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]]
    return [[(1.0 if i == j else 0.0) * c + s * cross[i][j] + (1 - c) * k[i] * k[j]
             for j in range(3)] for i in range(3)]

models = {d['add_model']['name']: d['add_model'] for d in directives if 'add_model' in d}
welds = {d['add_weld']['child'].split('::')[0]: d['add_weld'] for d in directives if 'add_weld' in d}
ground = models.pop('ground')
assert ground['file'] == 'package://rooms/ground.sdf' and 'ground' not in welds, ground
assert len(models) == len(scene['objects']) == 42, len(models)
for thing in scene['objects']:
    model = models[thing['name']]
    slot, file = thing['urdf'].split('/')[-2:]
    link = file[:-len('.urdf')]
    assert model['file'] == 'package://rooms/assets/%s/%s.sdf' % (slot, link), model
    assert thing['slot'] == slot
    assert (thing['name'] in welds) == thing['welded']
    if thing['welded']:
        weld = welds[thing['name']]
        assert weld['parent'] == 'world' and weld['child'] == thing['name'] + '::' + link
        assert 'default_free_body_pose' not in model
        pose = weld['X_PC']
    else:
        (body, pose), = model['default_free_body_pose'].items()
        assert body == link
    assert len(pose['translation']) == 3
    for a, b in zip(pose['translation'], thing['translation']):
        assert isinstance(a, float) and a == b, (a, b)
    ours, theirs = turn_of(pose['rotation']), turn_of_quaternion(*thing['quaternion_wxyz'])
    for i in range(3):
        for j in range(3):
            assert abs(ours[i][j] - theirs[i][j]) < 1e-12, thing
)";

std::vector<SceneObject> SceneFilesObjects() {
  core::Rng rng = core::StreamRng(4, 1);
  std::vector<SceneObject> objects;
  for (int i = 0; i < 42; ++i) {
    SceneObject object;
    object.category = i % 3 == 0 ? "apple_2" : i % 3 == 1 ? "apple" : "1_0";
    object.welded = i % 5 == 0;
    const auto sample = [&] { return core::Uniform(rng, -1.0, 1.0); };
    object.world_from_object.linear() =
        Eigen::Quaterniond(sample(), sample(), sample(), sample()).normalized().toRotationMatrix();
    object.world_from_object.translation() = Eigen::Vector3d(sample(), 1e-5 * sample(), sample());
    if (i == 0) object.world_from_object.setIdentity();
    if (i == 1) {  // a rotation by 180 degrees, and a tiny one
      object.world_from_object.linear() =
          Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
    }
    if (i == 2) {
      object.world_from_object.linear() =
          Eigen::AngleAxisd(1e-7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      object.world_from_object.translation() = Eigen::Vector3d(1e-5, 2.0, 1e-300);
    }
    objects.push_back(object);
  }
  return objects;
}

ExportedAssets Assets() {
  ExportedAssets assets;
  for (const char* const category : {"apple", "apple_2", "1_0"}) {
    assets::Asset asset;
    asset.name = std::string(category) + "_7";
    assets[category] = {category, std::string("../assets/") + category + "/", asset};
  }
  return assets;
}

TEST(SceneFiles, PythonReadsTheSamePosesFromBoth) {
  const core::TemporaryFolder folder;
  const ExportedAssets assets = Assets();
  const ExportedScene scene{"scene_00003", "pantry", 3,
                            WorldObjectsOf(SceneFilesObjects(), assets)};
  const auto at = [&](const char* name) { return (folder.path() / name).string(); };
  core::WriteFile(at("scene.json"), SceneJson(scene));
  core::WriteFile(at("scene.dmd.yaml"), DrakeDirectives(scene, "rooms"));
  core::WriteFile(at("read.py"), kScript);
  const std::string command =
      "/usr/bin/python3 " + at("read.py") + " " + at("scene.json") + " " + at("scene.dmd.yaml");
  EXPECT_EQ(std::system(command.c_str()), 0) << DrakeDirectives(scene, "rooms").substr(0, 1500);
}

TEST(SceneFiles, JsonKeepsEveryDigit) {
  const ExportedAssets assets = Assets();
  const std::vector<SceneObject> objects = SceneFilesObjects();
  const auto json = nlohmann::json::parse(
      SceneJson({"scene_00003", "pantry", 3, WorldObjectsOf(objects, assets)}));
  EXPECT_EQ(json["scene"], 3);
  ASSERT_EQ(json["objects"].size(), objects.size());
  std::set<std::string> names;
  for (size_t i = 0; i < objects.size(); ++i) {
    const auto& thing = json["objects"][i];
    names.insert(thing["name"].get<std::string>());
    EXPECT_EQ(thing["slot"], objects[i].category);
    EXPECT_EQ(thing["urdf"],
              "../assets/" + objects[i].category + "/" + objects[i].category + "_7.urdf");
    EXPECT_EQ(thing["welded"], objects[i].welded);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(thing["translation"][k].get<double>(),
                objects[i].world_from_object.translation()[k]);
    }
    const auto q = thing["quaternion_wxyz"].get<std::vector<double>>();
    const Eigen::Matrix3d turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    EXPECT_LT((turn - objects[i].world_from_object.linear()).norm(), 1e-14);
  }
  // "apple" and "apple_2" give distinct names.
  EXPECT_EQ(names.size(), objects.size());
}

TEST(WorldObjectsOf, SaysWhichSlotHasNoAsset) {
  ExportedAssets assets = Assets();
  assets.erase("apple_2");
  try {
    WorldObjectsOf(SceneFilesObjects(), assets);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("apple_2"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace simwright::scene
