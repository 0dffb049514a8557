#include "core/hdf5.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "core/error.h"

namespace simwright::core {
namespace {
namespace fs = std::filesystem;

std::vector<double> Doubles(std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = std::sin(static_cast<double>(i)) * 1e3;
  return values;
}

void WriteSample(const fs::path& path) {
  Hdf5Writer writer(path);
  writer.root().SetAttribute("whole", std::int64_t{-5});
  writer.root().SetAttribute("text", "Grüße {\"a\": 1}\nzwei");
  Hdf5Group group = writer.root().Create("group");
  group.SetAttribute("empty", "");
  group.Create("inner");
  const std::vector<double> numbers = Doubles(60);
  group.Write("plain", {60}, numbers.data());
  group.Write("packed", {5, 3, 4}, numbers.data(), {.rows_per_chunk = 2, .gzip = 4});
  const std::vector<float> floats(numbers.begin(), numbers.end());
  group.Write("floats", {30, 2}, floats.data(), {.rows_per_chunk = 100});
  const std::vector<std::uint8_t> bytes = {0, 1, 127, 255};
  group.Write("bytes", {2, 2}, bytes.data());
  const std::vector<std::int64_t> whole = {std::numeric_limits<std::int64_t>::min(), 0, 7};
  group.Write("whole", {3}, whole.data());
  group.Write<float>("none", {0, 3}, nullptr, {.rows_per_chunk = 10, .gzip = 1});
  group.WriteTexts("texts", {"demo_0", "demo_10"});
  writer.Commit();
}

TEST(Hdf5, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.hdf5";
  WriteSample(path);
  const Hdf5Reader reader(path);
  const Hdf5Group& root = reader.root();
  EXPECT_EQ(root.Children(), std::vector<std::string>{"group"});
  EXPECT_EQ(root.IntegerAttribute("whole"), -5);
  EXPECT_EQ(root.TextAttribute("text"), "Grüße {\"a\": 1}\nzwei");
  const Hdf5Group group = root.Open("group");
  EXPECT_EQ(group.Children(), (std::vector<std::string>{"bytes", "floats", "inner", "none",
                                                        "packed", "plain", "texts", "whole"}));
  EXPECT_EQ(group.TextAttribute("empty"), "");
  EXPECT_TRUE(group.Has("inner"));
  EXPECT_FALSE(group.Has("outer"));
  const std::vector<double> numbers = Doubles(60);
  EXPECT_EQ(group.Read<double>("plain").values, numbers);
  EXPECT_EQ(group.Read<double>("packed").values, numbers);
  EXPECT_EQ(group.Read<double>("packed").shape, (std::vector<std::size_t>{5, 3, 4}));
  EXPECT_EQ(group.Read<float>("floats").values, std::vector<float>(numbers.begin(), numbers.end()));
  // A float reads as a double, but a double not as a float, and no number as an integer.
  EXPECT_EQ(group.Read<double>("floats").values[7], static_cast<float>(numbers[7]));
  EXPECT_THROW(group.Read<float>("plain"), Error);
  EXPECT_THROW(group.Read<std::int64_t>("plain"), Error);
  EXPECT_THROW(group.Read<double>("whole"), Error);
  EXPECT_EQ(group.Read<std::uint8_t>("bytes").values, (std::vector<std::uint8_t>{0, 1, 127, 255}));
  EXPECT_EQ(group.Read<std::int64_t>("bytes").values[3], 255);
  EXPECT_EQ(group.Read<std::int64_t>("whole").values[0], std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(group.Shape("none"), (std::vector<std::size_t>{0, 3}));
  EXPECT_TRUE(group.Read<float>("none").values.empty());
  EXPECT_EQ(group.ReadTexts("texts"), (std::vector<std::string>{"demo_0", "demo_10"}));
}

TEST(Hdf5, ReadsRowsOfADataset) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.hdf5";
  WriteSample(path);
  const Hdf5Reader reader(path);
  const Hdf5Group group = reader.root().Open("group");
  const std::vector<double> numbers = Doubles(60);
  const Hdf5Array<double> rows = group.ReadRows<double>("packed", 1, 3);
  EXPECT_EQ(rows.shape, (std::vector<std::size_t>{3, 3, 4}));
  EXPECT_EQ(rows.values, std::vector<double>(numbers.begin() + 12, numbers.begin() + 48));
  EXPECT_EQ(group.ReadRows<std::uint8_t>("bytes", 1, 1).values,
            (std::vector<std::uint8_t>{127, 255}));
  EXPECT_TRUE(group.ReadRows<double>("packed", 5, 0).values.empty());
  EXPECT_THROW(group.ReadRows<double>("packed", 3, 3), Error);
  EXPECT_THROW(group.ReadRows<double>("packed", 6, 0), Error);
  EXPECT_THROW(group.ReadRows<double>("packed", 1, ~std::size_t{0}), Error);
  EXPECT_THROW(group.ReadRows<float>("packed", 0, 1), Error);
  EXPECT_THROW(group.ReadRows<double>("packed", 0, 5, 100), Error);
}

TEST(Hdf5, SameCallsSameBytesWhenever) {
  const TemporaryFolder folder;
  WriteSample(folder.path() / "a.hdf5");
  // By default the library stores the time of creation of a dataset.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  WriteSample(folder.path() / "b.hdf5");
  EXPECT_EQ(ReadFile(folder.path() / "a.hdf5"), ReadFile(folder.path() / "b.hdf5"));
}

TEST(Hdf5, AppearsWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.hdf5";
  const auto entries = [&] { return std::distance(fs::directory_iterator(folder.path()), {}); };
  {
    Hdf5Writer writer(path);
    writer.root().Create("half");
    EXPECT_FALSE(fs::exists(path));
  }
  EXPECT_EQ(entries(), 0);
  WriteSample(path);
  const std::string before = ReadFile(path);
  {
    Hdf5Writer writer(path);
    writer.root().Create("half");
  }
  EXPECT_EQ(ReadFile(path), before);
  EXPECT_EQ(entries(), 1);
  EXPECT_THROW(Hdf5Writer(folder.path() / "none" / "a.hdf5"), Error);
}

TEST(Hdf5, RefusesWithOneLineAndPrintsNothing) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.hdf5";
  WriteSample(path);
  testing::internal::CaptureStderr();
  const auto line = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  {
    const Hdf5Reader reader(path);
    const Hdf5Group group = reader.root().Open("group");
    EXPECT_NE(line([&] { group.Read<double>("nothing"); }).find("a.hdf5/group/nothing"),
              std::string::npos);
    EXPECT_NE(line([&] { group.Read<double>("inner"); }), "");
    EXPECT_NE(line([&] { group.Open("plain"); }), "");
    EXPECT_NE(line([&] { reader.root().Open("outer"); }), "");
    EXPECT_NE(line([&] { reader.root().TextAttribute("whole"); }), "");
    EXPECT_NE(line([&] { reader.root().IntegerAttribute("text"); }), "");
    EXPECT_NE(line([&] { reader.root().IntegerAttribute("missing"); }), "");
    EXPECT_NE(line([&] { group.ReadTexts("plain"); }), "");
    EXPECT_NE(line([&] { group.Read<double>("plain", 100); }), "");
  }
  const std::string whole = ReadFile(path);
  WriteFile(path, whole.substr(0, whole.size() / 2));
  EXPECT_NE(line([&] { Hdf5Reader reader(path); }).find("a.hdf5"), std::string::npos);
  WriteFile(path, "not at all");
  EXPECT_NE(line([&] { Hdf5Reader reader(path); }), "");
  EXPECT_NE(line([&] { Hdf5Reader reader(folder.path() / "missing"); }), "");
  Hdf5Writer writer(folder.path() / "b.hdf5");
  writer.root().Create("once");
  EXPECT_NE(line([&] { writer.root().Create("once"); }), "");
  const double one = 1.0;
  EXPECT_NE(line([&] { writer.root().Write("x", {}, &one, {.rows_per_chunk = 1}); }), "");
  EXPECT_NE(line([&] { writer.root().WriteText("x", std::string("a\0b", 3)); }), "");
  EXPECT_NE(line([&] { writer.root().Write("x", {1}, &one, {.gzip = 4}); }), "");
  EXPECT_NE(line([&] { writer.root().WriteTexts("x", {""}); }), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Hdf5, ScalarsAreReadBack) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.hdf5";
  {
    Hdf5Writer writer(path);
    const double mass = 0.25;
    writer.root().Write("mass", {}, &mass);
    writer.root().WriteText("file", "solid.obj");
    writer.Commit();
  }
  const Hdf5Reader reader(path);
  EXPECT_TRUE(reader.root().Shape("mass").empty());
  EXPECT_EQ(reader.root().Read<double>("mass").values, std::vector<double>{0.25});
  EXPECT_EQ(reader.root().ReadTexts("file"), std::vector<std::string>{"solid.obj"});
}

}  // namespace
}  // namespace simwright::core
