#include "core/folder_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "core/error.h"
#include "core/files.h"

namespace simwright::core {
namespace {

std::string Refusal(const std::filesystem::path& folder) {
  try {
    const FolderLock lock(folder, "a training");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FolderLock, ASecondHolderIsRefusedAndTheFirstIsNamed) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path() / "run";
  {
    const FolderLock lock(folder, "a training");  // creates the folder
    const std::string refusal = Refusal(folder);
    EXPECT_NE(
        refusal.find("a training is already running there, process " + std::to_string(getpid())),
        std::string::npos)
        << refusal;
  }
  EXPECT_EQ(Refusal(folder), "");
}

TEST(FolderLock, RemovesItsFolderIfNothingElseWasWrittenThere) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path() / "run";
  { const FolderLock lock(folder, "a training"); }
  EXPECT_FALSE(std::filesystem::exists(folder));
  {
    const FolderLock lock(folder, "a training");
    WriteFile(folder / "loss.csv", "step,loss\n");
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "loss.csv"));
  const std::filesystem::path existing = temporary.path() / "existing";
  std::filesystem::create_directory(existing);
  { const FolderLock lock(existing, "a training"); }
  EXPECT_TRUE(std::filesystem::exists(existing));
}

// A killed process cannot clean up, but what it leaves blocks nobody.
TEST(FolderLock, IsFreeAfterItsHolderWasKilled) {
  const TemporaryFolder folder;
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const FolderLock lock(folder.path(), "a training");
    if (write(ready[1], "x", 1) != 1) _exit(1);
    pause();
    _exit(1);
  }
  char byte;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_NE(Refusal(folder.path()).find("process " + std::to_string(child)), std::string::npos);
  ASSERT_EQ(kill(child, SIGKILL), 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_EQ(Refusal(folder.path()), "");
  close(ready[0]);
  close(ready[1]);
}

// The rest of an older holder's longer number must not be read as part of the next one's.
TEST(FolderLock, SaysOnlyTheLastHolder) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / ".lock", "99999999999999\n");
  const FolderLock lock(folder.path(), "a training");
  EXPECT_EQ(ReadFile(folder.path() / ".lock"), std::to_string(getpid()) + "\n");
}

}  // namespace
}  // namespace simwright::core
