#include "core/files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"

namespace simwright::core {
namespace {
namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() /
            (std::string("simwright_files_") +
             ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  int Entries() const { return static_cast<int>(std::distance(fs::directory_iterator(root_), {})); }
  fs::path root_;
};

TEST_F(Files, WritesWholeAndReadsBack) {
  WriteFile(root_ / "a", "hello");
  WriteFile(root_ / "a", "world");
  EXPECT_EQ(ReadFile(root_ / "a"), "world");
  EXPECT_EQ(Entries(), 1);
  EXPECT_THROW(ReadFile(root_ / "missing"), Error);
  EXPECT_THROW(ReadFile(root_), Error);
  EXPECT_THROW(ReadFile(root_ / "a", 2), Error);
}

TEST_F(Files, FullDiskKeepsTheOldFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  // /dev/full fails every write with "no space"; the rename target is never touched.
  EXPECT_THROW(WriteFile("/dev/full/x", "bytes"), Error);
  WriteFile(root_ / "a", "old");
  EXPECT_THROW(WriteFile(root_ / "none" / "a", "new"), Error);
  EXPECT_EQ(ReadFile(root_ / "a"), "old");
}

TEST_F(Files, NothingLeadsOutside) {
  EXPECT_NO_THROW(ResolveInside(root_, "sub/../a"));
  EXPECT_THROW(ResolveInside(root_, "../a"), Error);
  EXPECT_THROW(ResolveInside(root_, "/etc/passwd"), Error);
  fs::create_symlink("/etc", root_ / "link");
  EXPECT_THROW(ResolveInside(root_, "link/passwd"), Error);
}

TEST_F(Files, StagedFolderAppearsWholeOrNotAtAll) {
  {
    StagedFolder output(root_ / "deep" / "out", false);
    WriteFile(output.staging() / "x", "1");
  }
  EXPECT_EQ(Entries(), 0);
  {
    StagedFolder output(root_ / "out", false);
    WriteFile(output.staging() / "x", "1");
    output.Commit();
  }
  EXPECT_EQ(ReadFile(root_ / "out" / "x"), "1");
  EXPECT_THROW(StagedFolder(root_ / "out", false), Error);
  {
    StagedFolder output(root_ / "out", true);
    WriteFile(output.staging() / "y", "2");
  }
  EXPECT_EQ(ReadFile(root_ / "out" / "x"), "1");
  {
    StagedFolder output(root_ / "out", true);
    WriteFile(output.staging() / "y", "2");
    output.Commit();
  }
  EXPECT_FALSE(fs::exists(root_ / "out" / "x"));
  EXPECT_EQ(Entries(), 1);
}

TEST_F(Files, ForceReplacesNoFolderThatIsNoOutput) {
  fs::create_directories(root_ / "code" / ".git");
  fs::create_directories(root_ / "people" / "me");
  EXPECT_THROW(StagedFolder(root_ / "code", true), Error);
  EXPECT_THROW(StagedFolder(fs::current_path(), true), Error);
  EXPECT_THROW(StagedFolder(fs::current_path().parent_path(), true), Error);
  const char* const home = std::getenv("HOME");
  const std::string before = home == nullptr ? "" : home;
  setenv("HOME", (root_ / "people" / "me").c_str(), 1);
  EXPECT_THROW(StagedFolder(root_ / "people", true), Error);
  EXPECT_THROW(StagedFolder(root_ / "people" / "me", true), Error);
  EXPECT_NO_THROW(StagedFolder(root_ / "people" / "me" / "out", true));
  home == nullptr ? unsetenv("HOME") : setenv("HOME", before.c_str(), 1);
  EXPECT_TRUE(fs::exists(root_ / "code" / ".git"));
}

}  // namespace
}  // namespace simwright::core
