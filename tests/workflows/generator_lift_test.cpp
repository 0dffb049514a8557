// `simwright lift` with a generator: a server in the test, or a program.
#include <gtest/gtest.h>
#include <zip.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "assets/asset_folder.h"
#include "assets/mesh_archive.h"
#include "core/base64.h"
#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "physics_params/category_resolution.h"
#include "program.h"
#include "running_program.h"

#include "tests/workflows/generator_server.h"  // last: see there

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

// A disc of 100 pixels across as a cut-out of 160 x 160 pixels, red.
fs::path WriteDisc(const fs::path& folder) {
  core::Image photo(160, 160, 4);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 160; ++x) {
      if (std::hypot(x + 0.5 - 70.0, y + 0.5 - 90.0) > 50.0) continue;
      photo.At(x, y)[0] = 200;
      photo.At(x, y)[3] = 255;
    }
  }
  core::WriteFile(folder / "disc.png", core::EncodePng(photo));
  return folder / "disc.png";
}

class GeneratorLift : public testing::Test {
 protected:
  Outcome Lift(const std::string& arguments) {
    return RunProgram("lift " + WriteDisc(folder_.path()).string() + " -o " + out().string() + " " +
                      arguments);
  }
  // Expects exit code 1, one line on stderr with `part`, and no output.
  void ExpectRefusal(const std::string& arguments, const std::string& part) {
    const Outcome lift = Lift("--quiet --category mug " + arguments);
    EXPECT_EQ(lift.code, 1) << lift.text;
    EXPECT_NE(lift.text.find(part), std::string::npos) << lift.text;
    EXPECT_TRUE(lift.text.starts_with("error: ")) << lift.text;
    EXPECT_EQ(std::count(lift.text.begin(), lift.text.end(), '\n'), 1) << lift.text;
    EXPECT_EQ(lift.text.find("/tmp/simwright_"), std::string::npos) << lift.text;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path().filename(), "disc.png");
    }
  }
  fs::path out() const { return folder_.path() / "asset"; }

  core::TemporaryFolder folder_;
};

// 1 wide, 2 high (y up), 0.5 deep; at a height of 0.2 m: 0.1 x 0.05 x 0.2 m.
TEST_F(GeneratorLift, AServersBoxBecomesAnAssetOfTheStatedHeight) {
  GeneratorServer server(Answering(BoxGlb(1.0f, 2.0f, 0.5f)));
  const Outcome lift = Lift("--category box --height 0.2 --mass 0.5 --generator " + server.url() +
                            " --keep-generated " + (folder_.path() / "raw.glb").string());
  ASSERT_EQ(lift.code, 0) << lift.text;
  const assets::Asset asset = assets::ReadAsset(out());
  const Eigen::Vector3d sides = core::Bounds(asset.visual.mesh).sizes();
  EXPECT_NEAR(sides.x(), 0.1, 1e-6);
  EXPECT_NEAR(sides.y(), 0.05, 1e-6);
  EXPECT_NEAR(sides.z(), 0.2, 1e-6);
  EXPECT_NEAR(asset.volume, 0.1 * 0.05 * 0.2, 1e-8);
  EXPECT_NEAR(asset.inertial.mass, 0.5, 1e-9);
  EXPECT_NEAR(asset.inertial.center_of_mass.z(), 0.1, 1e-6);
  EXPECT_EQ(asset.source, "disc.png by the generator " + server.url());
  EXPECT_EQ(core::ReadFile(folder_.path() / "raw.glb"), BoxGlb(1.0f, 2.0f, 0.5f));
  for (const char* picture : {"preview.png", "matte.png", "lift.png"}) {
    EXPECT_TRUE(fs::exists(out() / picture)) << picture;
  }
  // The server got the object in the middle of a square that it fills to 85 %.
  const nlohmann::json json = nlohmann::json::parse(server.seen().at(0).body);
  const core::Image seen =
      core::DecodeImage(core::FromBase64(json.at("image").get<std::string>()).value(), "seen");
  EXPECT_EQ(seen.width, 118);
  EXPECT_EQ(seen.height, 118);
  ASSERT_EQ(seen.channels, 4);
  int opaque = 0, column = 0;
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      if (seen.At(x, y)[3] < 128) continue;
      ++opaque;
      column += x;
    }
  }
  EXPECT_NEAR(opaque, M_PI * 50 * 50, 40);
  EXPECT_NEAR(static_cast<double>(column) / opaque, 58.5, 0.6);
  EXPECT_EQ(seen.At(0, 0)[0], 255);  // white below transparency
  EXPECT_EQ(core::ReadFile(out() / "matte.png"), core::EncodePng(seen));
}

TEST_F(GeneratorLift, WithoutASizeTheCategorySetsTheVolumeOfTheBox) {
  GeneratorServer server(Answering(
      nlohmann::json{{"model_base64", core::Base64(BoxGlb(40.0f, 50.0f, 40.0f))}}.dump()));
  const Outcome lift = Lift("--category mug --json --generator " + server.url());
  ASSERT_EQ(lift.code, 0) << lift.text;
  const nlohmann::json json = nlohmann::json::parse(lift.text);
  std::set<std::string> codes;
  for (const auto& finding : json.at("findings")) codes.insert(finding.at("code"));
  EXPECT_TRUE(codes.contains("generated"));
  EXPECT_TRUE(codes.contains("size-drawn"));
  EXPECT_TRUE(codes.contains("segmentation"));
  EXPECT_TRUE(json.at("assets")[0].at("silhouette_iou").is_null());
  const assets::Asset asset = assets::ReadAsset(out());
  const Eigen::Vector3d sides = core::Bounds(asset.visual.mesh).sizes();
  EXPECT_NEAR(sides.z() / sides.x(), 1.25, 1e-6);
  const physics_params::Category& mug = *physics_params::RequireCategory("mug").category;
  EXPECT_GE(sides.prod(), mug.length.min * mug.width.min * mug.height.min);
  EXPECT_LE(sides.prod(), mug.length.max * mug.width.max * mug.height.max);
  EXPECT_NEAR(asset.volume, sides.prod(), 1e-6 * sides.prod());
}

TEST_F(GeneratorLift, AProgramsMeshIsImportedAlike) {
  const fs::path glb = folder_.path() / "box.glb";
  core::WriteFile(glb, BoxGlb(1.0f, 2.0f, 0.5f));
  const Outcome lift = Lift(
      "--category box --height 0.2 --generator-command \"sh -c 'test -s "
      "\\\"\\$0\\\" && cp " +
      glb.string() + " \\\"\\$1\\\"' {in} {out}\"");
  ASSERT_EQ(lift.code, 0) << lift.text;
  const assets::Asset asset = assets::ReadAsset(out());
  EXPECT_NEAR(asset.volume, 0.1 * 0.05 * 0.2, 1e-8);
  EXPECT_EQ(asset.source, "disc.png by the generator sh");
}

TEST_F(GeneratorLift, FaultsAreOneLineAndLeaveNothing) {
  const std::string glb = BoxGlb(1, 2, 0.5);
  for (const std::string& broken :
       {glb.substr(0, glb.size() / 2), glb.substr(0, 20), std::string("glTF"),
        std::string("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n")}) {
    GeneratorServer server(Answering(broken));
    ExpectRefusal("--generator " + server.url(), "the mesh from " + server.url());
  }
  GeneratorServer page(Answering("<html>502</html>"));
  ExpectRefusal("--generator " + page.url(), "a web page (HTML)");
  GeneratorServer empty(Answering(""));
  ExpectRefusal("--generator " + empty.url(), "its answer is empty");
  ExpectRefusal("--generator-command 'false {in} {out}'",
                "false: the program ended with exit code 1");
  ExpectRefusal("--generator-command false", "has no {in}");
  ExpectRefusal("--generator localhost:1/x", "");
  ExpectRefusal("--segmenter nothing.onnx", "nothing.onnx");
}

TEST_F(GeneratorLift, AnExistingOutputIsRefusedBeforeThePhotoIsSent) {
  fs::create_directory(out());
  GeneratorServer server(Answering(BoxGlb(1, 2, 0.5)));
  const Outcome lift = Lift("--category box --generator " + server.url());
  EXPECT_EQ(lift.code, 1) << lift.text;
  EXPECT_TRUE(server.seen().empty());
}

TEST_F(GeneratorLift, TheKeyComesFromTheEnvironmentAndIsNeverShown) {
  setenv("SIMWRIGHT_GENERATOR_KEY", kGeneratorKey, 1);
  GeneratorServer server(Answering(std::string("no credit for ") + kGeneratorKey, 402));
  const Outcome lift = Lift("--category mug --log-level trace --generator " + server.url());
  unsetenv("SIMWRIGHT_GENERATOR_KEY");
  EXPECT_EQ(lift.code, 1) << lift.text;
  EXPECT_EQ(server.seen().at(0).authorization, std::string("Bearer ") + kGeneratorKey);
  EXPECT_EQ(lift.text.find(kGeneratorKey), std::string::npos) << lift.text;
  EXPECT_NE(lift.text.find("status 402"), std::string::npos) << lift.text;
}

TEST_F(GeneratorLift, AConfigurationFileStartsNoProgram) {
  const fs::path config = folder_.path() / "simwright.toml";
  core::WriteFile(config, "[lift]\ngenerator-command = \"touch {in} {out}\"\n");
  const Outcome lift = Lift("--category mug --config " + config.string());
  EXPECT_EQ(lift.code, 2) << lift.text;
  EXPECT_NE(lift.text.find("generator-command"), std::string::npos) << lift.text;
}

TEST_F(GeneratorLift, CtrlCEndsTheProgramWhileTheServerWorks) {
  GeneratorServer* running = nullptr;
  GeneratorServer server([&](int, const httplib::Request&, httplib::Response&) {
    while (!running->stopping()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  running = &server;
  RunningProgram lift("lift " + WriteDisc(folder_.path()).string() + " --category mug -o " +
                          out().string() + " --generator " + server.url(),
                      folder_.path() / "log");
  ASSERT_TRUE(lift.WaitFor([&] { return !server.seen().empty(); }));
  const Outcome outcome = lift.EndBy(SIGINT);
  EXPECT_NE(outcome.code, 0) << outcome.text;
  EXPECT_FALSE(fs::exists(out()));
}

// The listing of docs/generator.md, with a model that answers with a box.
TEST_F(GeneratorLift, TheServerOfTheDocumentationWorks) {
  const std::string page = core::ReadFile(fs::path(SIMWRIGHT_SOURCE_DIR) / "docs/generator.md");
  const std::size_t first = page.find("    import base64"), last = page.find("\n\nA test extracts");
  ASSERT_NE(last, std::string::npos);
  std::istringstream listing(page.substr(first, last - first));
  // A port that was free a moment ago.
  const std::string port = [] {
    const std::string url = GeneratorServer(Answering("")).origin();
    return url.substr(url.rfind(':') + 1);
  }();
  std::string program;
  for (std::string line; std::getline(listing, line);) {
    const std::size_t at = line.find("8081");
    if (at != std::string::npos) line.replace(at, 4, port);
    program += line.substr(std::min<std::size_t>(4, line.size())) + "\n";
  }
  const core::TemporaryFolder server;
  core::WriteFile(server.path() / "server.py", program);
  core::WriteFile(server.path() / "box.glb", BoxGlb(1.0f, 2.0f, 0.5f));
  core::WriteFile(server.path() / "my_model.py",
                  "def glb_of(png):\n    assert png[1:4] == b'PNG'\n"
                  "    return open('" +
                      (server.path() / "box.glb").string() + "', 'rb').read()\n");
  const pid_t pid = fork();
  if (pid == 0) {
    execlp("python3", "python3", (server.path() / "server.py").c_str(), nullptr);
    _exit(127);
  }
  // A connection that is refused until the server listens is retried.
  const Outcome lift =
      Lift("--category box --height 0.2 --generator http://127.0.0.1:" + port + "/generate");
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  ASSERT_EQ(lift.code, 0) << lift.text;
  EXPECT_NEAR(assets::ReadAsset(out()).volume, 0.1 * 0.05 * 0.2, 1e-8);
}

// An archive of these names and texts.
std::string Zip(const fs::path& path, const std::vector<std::pair<std::string, std::string>>& all) {
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  for (const auto& [name, text] : all) {
    zip_file_add(archive, name.c_str(), zip_source_buffer(archive, text.data(), text.size(), 0), 0);
  }
  EXPECT_EQ(zip_close(archive), 0);
  const std::string bytes = core::ReadFile(path);
  fs::remove(path);
  return bytes;
}

TEST_F(GeneratorLift, AZipWithAnObjAndItsMaterialsIsUnpacked) {
  std::string obj = "mtllib box.mtl\nusemtl blue\n";
  for (int i = 0; i < 8; ++i) {
    obj += std::string("v ") + ((i & 1) ? "1 " : "0 ") + ((i & 2) ? "2 " : "0 ") +
           ((i & 4) ? "0.5\n" : "0\n");
  }
  obj += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const std::string bytes =
      Zip(folder_.path() / "a.zip", {{"out/box.obj", obj},
                                     {"out/box.mtl", "newmtl blue\nKd 0 0 1\n"},
                                     {"out/readme.txt", "hello"}});
  GeneratorServer server(Answering(bytes));
  const Outcome lift =
      Lift("--category box --height 0.2 --generator-up y --generator " + server.url());
  ASSERT_EQ(lift.code, 0) << lift.text;
  const assets::Asset asset = assets::ReadAsset(out());
  EXPECT_NEAR(asset.volume, 0.1 * 0.05 * 0.2, 1e-8);
  ASSERT_FALSE(asset.visual.triangle_material.empty());
  const int blue = asset.visual.triangle_material.front();
  EXPECT_NEAR(asset.visual.materials.at(static_cast<size_t>(blue)).base_color[2], 1.0, 0.01);
  EXPECT_NEAR(asset.visual.materials.at(static_cast<size_t>(blue)).base_color[0], 0.0, 0.01);
}

TEST_F(GeneratorLift, ZipsThatAreNoMeshAreRefused) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const fs::path path = folder_.path() / "a.zip";
  const auto refusal = [&](const std::string& bytes) {
    const core::TemporaryFolder folder;
    core::WriteFile(folder.path() / "b.zip", bytes);
    fs::create_directory(folder.path() / "in");
    try {
      assets::ExtractMeshArchive(folder.path() / "b.zip", folder.path() / "in");
    } catch (const core::Error& error) {
      EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect = [](const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::string good = Zip(path, {{"a.obj", obj}});
  EXPECT_EQ(refusal(good), "");
  expect("leads outside", refusal(Zip(path, {{"../a.obj", obj}})));
  expect("leads outside", refusal(Zip(path, {{"/a.obj", obj}})));
  expect("has no GLB, OBJ or PLY", refusal(Zip(path, {{"a.txt", obj}})));
  expect("several meshes", refusal(Zip(path, {{"a.obj", obj}, {"b.obj", obj}})));
  expect("both a file and a folder", refusal(Zip(path, {{"a.obj", obj}, {"a.obj/b.obj", obj}})));
  expect("zip", refusal(good.substr(0, good.size() / 2)));
}

}  // namespace
}  // namespace simwright::workflows
