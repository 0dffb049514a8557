// The program on the command line: bad input gives one clear line, exit code 1 and no leftovers;
// good input gives the same bytes twice.
#include <gtest/gtest.h>
#include <zip.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"
#include "core/files.h"
#include "core/image.h"
#include "program.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

class CommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("simwright_cli_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  std::string Out() const { return (folder_ / "out").string(); }

  // One line "error: ...", exit 1, no output and no hidden leftovers.
  void ExpectRefused(const std::string& arguments, const std::string& word) {
    const size_t before = Entries();
    const Outcome outcome = RunProgram(arguments + " --quiet");
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << arguments << "\n" << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << arguments << "\n" << outcome.text;
    EXPECT_EQ(Entries(), before) << arguments << " left something behind";
  }
  // Faults of an existing model are results of its report: exit code 1, and a FAIL line with the
  // word.
  void ExpectFailRow(const std::string& arguments, const std::string& word) {
    const Outcome outcome = RunProgram(arguments + " --quiet");
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.text;
    const size_t row = outcome.text.find("FAIL");
    ASSERT_NE(row, std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find(word, row), std::string::npos) << outcome.text;
  }
  size_t Entries() const {
    return static_cast<size_t>(std::distance(fs::recursive_directory_iterator(folder_), {}));
  }
  fs::path folder_;
};

core::Image DiscPhoto(int size) {
  core::Image photo(size, size, 4);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double dx = x - 0.5 * size, dy = y - 0.5 * size;
      if (dx * dx + dy * dy > 0.09 * size * size) continue;
      photo.At(x, y)[0] = static_cast<uint8_t>(120 + 100 * x / size);
      photo.At(x, y)[1] = 60;
      photo.At(x, y)[3] = 255;
    }
  }
  return photo;
}

TEST_F(CommandLine, BadPhotosAreRefused) {
  const auto lift = [&](const std::string& photo) {
    return "lift " + photo + " --category apple -o " + Out();
  };
  const std::string png = core::EncodePng(DiscPhoto(64));
  ExpectRefused(lift(folder_ / "none.png"), "no such file");
  ExpectRefused(lift(Write("text.png", "this is a text")), "not a readable image");
  ExpectRefused(lift(Write("empty.png", "")), "empty");
  ExpectRefused(lift(Write("cut.png", png.substr(0, png.size() / 2))), "truncated");
  ExpectRefused(lift(Write("one.png", core::EncodePng(core::Image(1, 1, 3, 90)))), "1 x 1");
  ExpectRefused(lift(Write("clear.png", core::EncodePng(core::Image(64, 64, 4)))), "transparent");
  ExpectRefused(lift(Write("flat.png", core::EncodePng(core::Image(64, 64, 3, 90)))), "object");
  core::Image two(128, 64, 4);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double dx = x % 64 - 32, dy = y - 32;
      two.At(x, y)[3] = dx * dx + dy * dy < 400 ? 255 : 0;
    }
  }
  ExpectRefused(lift(Write("two.png", core::EncodePng(two))), "objects");
  std::string huge = png;
  const std::string side("\x00\x01\x86\xA0", 4);
  huge.replace(16, 4, side);
  huge.replace(20, 4, side);
  ExpectRefused(lift(Write("huge.png", huge)), "100000 x 100000");
  Write("disc.png", png);
  ExpectRefused("lift " + (folder_ / "disc.png").string() + " --category democracy -o " + Out(),
                "--category one of: ");
}

TEST_F(CommandLine, BadMeshesAreRefused) {
  const auto import = [&](const std::string& mesh) { return "import " + mesh + " -o " + Out(); };
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  ExpectRefused(import(Write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")), "error");
  ExpectRefused(import(Write("bare.obj", three)), "error");
  ExpectRefused(import(Write("tiny.obj", "v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nf 1 2 3\n")), "--size");
  ExpectRefused(import(Write("vast.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1e9 0\nf 1 2 3\n")), "--size");
  ExpectRefused(import(Write("point.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n")), "error");
  ExpectRefused(import(Write("bad.sh3f", "no zip")), "catalogue");
  ExpectRefused(import((folder_ / "none").string()), "no such");
}

TEST_F(CommandLine, TrainingRefusesWhatIsNotThere) {
  const std::string train = "prior train --parametric-only -o " + Out();
  ExpectRefused(train + " --from " + (folder_ / "none").string(), "shape_prior.pt");
  ExpectRefused(train + " --batch 4 --only view", "shape_prior.pt");  // it needs the shape prior
  for (const char* prior : {"library", "detector"}) {
    ExpectRefused(train + " --only " + prior + " --from " + (folder_ / "none").string(), prior);
  }
  ExpectRefused(train + " --photos " + (folder_ / "none").string(), "none");
  ExpectRefused(train + " --only shape --photos " + Out(), "leave out --photos");
  ExpectRefused("prior train -o " + Out() + " " + (folder_ / "none.sh3f").string(), "none.sh3f");
}

TEST_F(CommandLine, ACatalogueThatClimbsOutIsRefused) {
  const std::string path = (folder_ / "evil.sh3f").string(), text = "id#1=a\n";
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE, &code);
  for (const char* name : {"PluginFurnitureCatalog.properties", "../../evil.obj"}) {
    zip_file_add(archive, name, zip_source_buffer(archive, text.data(), text.size(), 0), 0);
  }
  ASSERT_EQ(zip_close(archive), 0);
  ExpectRefused("import " + path + " -o " + Out(), "outside");
}

TEST_F(CommandLine, BadUrdfsFail) {
  const auto check = [&](const std::string& name, const std::string& body) {
    return "check " + Write(name, "<robot name='r'>" + body + "</robot>");
  };
  const std::string links = "<link name='a'/><link name='b'/>";
  const auto joint = [](const std::string& name, const std::string& from, const std::string& to) {
    return "<joint name='" + name + "' type='fixed'><parent link='" + from + "'/><child link='" +
           to + "'/></joint>";
  };
  ExpectFailRow(check("loop.urdf", links + joint("j", "a", "b") + joint("k", "b", "a")), "loop");
  ExpectFailRow(check("gone.urdf", links + joint("j", "a", "c")), "c");
  ExpectFailRow(check("light.urdf",
                      "<link name='a'><inertial><mass value='-1'/><inertia ixx='1' "
                      "iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"),
                "mass");
  ExpectFailRow(check("away.urdf",
                      "<link name='a'><collision><geometry><mesh "
                      "filename='../../../../etc/passwd'/></geometry></collision>"
                      "</link>"),
                "outside");
  std::string bomb = "<!DOCTYPE robot [<!ENTITY a0 'ha'>";
  for (int i = 1; i < 30; ++i) {
    const std::string before = "&a" + std::to_string(i - 1) + ";";
    bomb += "<!ENTITY a" + std::to_string(i) + " '" + before + before + "'>";
  }
  ExpectFailRow("check " + Write("bomb.urdf", bomb + "]><robot name='&a29;'/>"), "bomb.urdf");
}

// A photo of 12 megapixels is downscaled: it takes no longer than a small one.
TEST_F(CommandLine, LargePhotosAreOrdinary) {
  Write("large.jpg",
        core::EncodeJpeg(
            core::Resize(core::ReadImage(SIMWRIGHT_SOURCE_DIR "/examples/apple.jpg"), 4000, 3000),
            90));
  const Outcome outcome =
      RunProgram("lift " + (folder_ / "large.jpg").string() + " --category apple -o " + Out());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

// A scan of two million faces is decimated.
TEST_F(CommandLine, LargeMeshesAreOrdinary) {
  constexpr int kRings = 1000;  // 2 * 1000^2: two million faces
  std::string stl(84 + 50ull * 2 * kRings * kRings, '\0');
  const auto point = [&](int i, int j) {
    const double polar = M_PI * i / kRings, turn = 2.0 * M_PI * j / kRings;
    const double r = 0.1 + 0.004 * std::sin(8 * polar) * std::sin(6 * turn) * std::sin(polar);
    return std::array<float, 3>{static_cast<float>(r * std::sin(polar) * std::cos(turn)),
                                static_cast<float>(r * std::sin(polar) * std::sin(turn)),
                                static_cast<float>(r * std::cos(polar))};
  };
  const std::uint32_t faces = 2 * kRings * kRings;
  std::memcpy(&stl[80], &faces, 4);
  char* at = &stl[84];
  const auto face = [&](const std::array<std::array<float, 3>, 3>& corners) {
    std::memcpy(at + 12, corners.data(), 36);
    at += 50;
  };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kRings; ++j) {
      const int k = (j + 1) % kRings;
      face({point(i, j), point(i + 1, j), point(i + 1, k)});
      face({point(i, j), point(i + 1, k), point(i, k)});
    }
  }
  const Outcome outcome =
      RunProgram("import " + Write("scan.stl", stl) + " --category object -o " + Out());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

TEST_F(CommandLine, TheExampleChairBecomesAnAssetThatHolds) {
  const Outcome outcome = RunProgram(
      "import " SIMWRIGHT_SOURCE_DIR "/examples/chair.obj --category chair --quiet -o " + Out());
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const Outcome check = RunProgram("check " + Out() + "/chair");
  EXPECT_EQ(check.code, 0) << check.text;
  EXPECT_EQ(check.text.find("fail"), std::string::npos) << check.text;
}

TEST_F(CommandLine, CtrlCLeavesNothing) {
  const std::string mesh = Write("ball.obj", assets::ObjText(assets::SphereMesh(0.1, 200)));
  const size_t before = Entries();
  // A shell starts background processes with SIGINT ignored: wait until the process has become the
  // program, whose shell may have caught it, and the program catches it.
  const Outcome outcome =
      RunProgram("import " + mesh + " --category ball -o " + Out() +
                 " 2>&1 & pid=$!; for i in $(seq 400); do "
                 "grep -q simwright /proc/$pid/comm && "
                 "grep -q 'SigCgt.*[2367abef]$' /proc/$pid/status && break; sleep 0.05; done; "
                 "sleep 0.3; kill -INT $pid; wait $pid");
  EXPECT_NE(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("stopped"), std::string::npos) << outcome.text;
  EXPECT_EQ(Entries(), before);
}

TEST_F(CommandLine, WrongUsageIsExitTwo) {
  EXPECT_EQ(RunProgram("lift").code, 2);
  EXPECT_EQ(RunProgram("no-such-command").code, 2);
  EXPECT_EQ(RunProgram("import x.obj -o y --unit parsec").code, 2);
  EXPECT_EQ(RunProgram("scene sample --type dimsum -o " + Out() + " --device gpu").code, 2);
  EXPECT_EQ(RunProgram("--help").code, 0);
  for (const char* command : {"lift", "import", "physics", "check", "doctor", "version"}) {
    const Outcome help = RunProgram(std::string(command) + " --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.text.find("Example"), std::string::npos) << command;
  }
}

// Ceres brings ATLAS along, which would serve libtorch's products too.
TEST_F(CommandLine, TheProgramMultipliesByOpenBlas) {
  const Outcome outcome = RunProgram("doctor");
  EXPECT_NE(outcome.text.find("openblas"), std::string::npos) << outcome.text;
}

TEST_F(CommandLine, OneOpenFaceBecomesASheetWithAWall) {
  const std::string mesh = Write("sheet.obj", "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nf 1 2 3\n");
  const Outcome outcome =
      RunProgram("import " + mesh + " --category tray -o " + Out() + " --no-check");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const std::string json = core::ReadFile(folder_ / "out" / "sheet" / "asset.json");
  EXPECT_NE(json.find("sheet_thickness_m"), std::string::npos);
}

// The written collision meshes keep the limits, and the finding states what the precision takes.
TEST_F(CommandLine, CollisionPartsStayWithinTheirBudget) {
  const std::string mesh = Write("cup.obj", assets::ObjText(shapes::Cup(.04, .1, .004, 48)));
  const Outcome outcome =
      RunProgram("import " + mesh + " --category mug --up z --unit m --no-check --max-parts 5 " +
                 "--max-vertices 40 --max-faces 60 --part-tolerance 0.001 -o " + Out());
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("[part-budget]"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("a tolerance of 1.00 mm would take"), std::string::npos);
  int parts = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out" / "cup")) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("collision_", 0) != 0 || entry.path().extension() != ".obj") continue;
    ++parts;
    const std::string text = "\n" + core::ReadFile(entry.path());
    int vertices = 0, faces = 0;
    for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; ++at) {
      vertices += text.compare(at + 1, 2, "v ") == 0;
      faces += text.compare(at + 1, 2, "f ") == 0;
    }
    EXPECT_GE(vertices, 4) << name;
    EXPECT_LE(vertices, 32) << name;  // 60 faces have 32 vertices
    EXPECT_LE(faces, 60) << name;
  }
  EXPECT_GE(parts, 2);
  EXPECT_LE(parts, 5);
  EXPECT_EQ(RunProgram("import " + mesh + " -o " + Out() + " --max-vertices 8").code, 2);
}

TEST_F(CommandLine, AnExistingOutputIsKeptUnlessForced) {
  const std::string mesh = Write("box.obj", assets::ObjText(assets::BoxMesh({0.2, 0.1, 0.1})));
  const std::string import = "import " + mesh + " --category box -o " + Out();
  ASSERT_EQ(RunProgram(import).code, 0) << RunProgram(import + " --force").text;
  const fs::path file = folder_ / "out" / "box" / "asset.json";
  std::ofstream(file, std::ios::app) << "\n";
  const std::string marked = core::ReadFile(file);
  ExpectRefused(import, "--force");
  EXPECT_EQ(core::ReadFile(file), marked);
  EXPECT_EQ(RunProgram(import + " --resume --quiet").code, 0);
  EXPECT_EQ(core::ReadFile(file), marked);
  EXPECT_EQ(RunProgram(import + " --force --quiet").code, 0);
  EXPECT_NE(core::ReadFile(file), marked);
}

TEST_F(CommandLine, AFullDiskLeavesNothing) {
  // A folder cannot be created below a device.
  const std::string mesh = Write("box.obj", assets::ObjText(assets::BoxMesh({0.2, 0.1, 0.1})));
  ExpectRefused("import " + mesh + " --category box -o /dev/full/out", "error");
}

TEST_F(CommandLine, TheSameSeedGivesTheSameBytes) {
  Write("disc.png", core::EncodePng(DiscPhoto(160)));
  for (const char* name : {"a/disc", "b/disc"}) {
    const Outcome outcome =
        RunProgram("lift " + (folder_ / "disc.png").string() + " --category orange --seed 7 -o " +
                   (folder_ / name).string());
    ASSERT_EQ(outcome.code, 0) << outcome.text;
  }
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "a" / "disc")) {
    ++files;
    EXPECT_EQ(core::ReadFile(entry.path()),
              core::ReadFile(folder_ / "b" / "disc" / entry.path().filename()))
        << entry.path();
  }
  EXPECT_GE(files, 10);
}

TEST_F(CommandLine, LiftedAndImportedAssetsPassTheirCheck) {
  Write("disc.png", core::EncodePng(DiscPhoto(160)));
  ASSERT_EQ(
      RunProgram("lift " + (folder_ / "disc.png").string() + " --category orange -o " + Out()).code,
      0);
  const Outcome check = RunProgram("check " + Out());
  EXPECT_EQ(check.code, 0) << check.text;
  const std::string mesh = Write("crate.obj", assets::ObjText(assets::BoxMesh({0.3, 0.2, 0.25})));
  const Outcome import =
      RunProgram("import " + mesh + " --category crate -o " + (folder_ / "m").string());
  EXPECT_EQ(import.code, 0) << import.text;
}

TEST_F(CommandLine, PhysicsPrintsRangesAndSample) {
  const Outcome outcome = RunProgram("physics --category mug --seed 3 --json");
  EXPECT_EQ(outcome.code, 0);
  for (const char* key : {"length_m", "width_m", "height_m", "mass_kg", "min", "max", "sample"}) {
    EXPECT_NE(outcome.text.find(key), std::string::npos) << key;
  }
  EXPECT_EQ(RunProgram("physics --category mug --seed 3 --json").text, outcome.text);
  EXPECT_NE(outcome.text.find("interval_90"), std::string::npos);
  ExpectRefused("physics --category mugg", "mug");
  const Outcome plastic = RunProgram("physics --category mug --material plastic --json");
  EXPECT_NE(plastic.text.find("\"plastic mug\""), std::string::npos) << plastic.text;
  ExpectRefused("physics --category mug --material concrete", "--material one of: ceramic");
  EXPECT_EQ(RunProgram("physics --category mug --size-class huge").code, 2);
}

}  // namespace
}  // namespace simwright
