#include "core/content_hash.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"

namespace simwright::core {
namespace {
namespace fs = std::filesystem;

// 128-bit FNV-1a of "" and "a" from the appendix of draft-eastlake-fnv.
TEST(ContentHash, IsFnv1a) {
  EXPECT_EQ(ContentHash(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(ContentHash("a"), "d228cb696f1a8caf78912b704e4a8964");
}

TEST(ContentHash, OfAFolderChangesWithEveryNameAndContent) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "meshes");
  WriteFile(folder.path() / "cup.urdf", "urdf");
  WriteFile(folder.path() / "meshes" / "cup.obj", "mesh");
  const std::string before = ContentHashOf(folder.path());
  EXPECT_EQ(ContentHashOf(folder.path()), before);
  EXPECT_EQ(ContentHashOf(folder.path() / "cup.urdf"), ContentHash("urdf"));
  WriteFile(folder.path() / "meshes" / "cup.obj", "another");
  EXPECT_NE(ContentHashOf(folder.path()), before);
  WriteFile(folder.path() / "meshes" / "cup.obj", "mesh");
  EXPECT_EQ(ContentHashOf(folder.path()), before);
  fs::rename(folder.path() / "cup.urdf", folder.path() / "mug.urdf");
  EXPECT_NE(ContentHashOf(folder.path()), before);
  EXPECT_THROW(ContentHashOf(folder.path() / "none"), Error);
  const auto is_note = [](const std::filesystem::path& file) { return file.stem() == "note"; };
  const std::string noteless = ContentHashOf(folder.path(), is_note);
  EXPECT_EQ(noteless, ContentHashOf(folder.path()));
  WriteFile(folder.path() / "note.txt", "later");
  EXPECT_EQ(ContentHashOf(folder.path(), is_note), noteless);
  EXPECT_NE(ContentHashOf(folder.path()), noteless);
}

}  // namespace
}  // namespace simwright::core
