// The tokenizer against pieces found by hand, and BERT's rules.
#include "scene/model/word_pieces.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"

namespace simwright::scene {
namespace {

WordPieces SmallVocabulary() {
  return WordPieces(
      {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "a", "tea", "##pot", "##s", "cup", ",", "."});
}

TEST(WordPieces, TakesTheLongestPiecesFromTheLeft) {
  const WordPieces pieces = SmallVocabulary();
  EXPECT_EQ(pieces.Encode("A teapot, teas.", 110), (std::vector<int>{2, 4, 5, 6, 9, 5, 7, 10, 3}));
  EXPECT_EQ(pieces.Encode("", 110), (std::vector<int>{2, 3}));
}

TEST(WordPieces, AWordThatNoPiecesSpellIsUnknownAsAWhole) {
  EXPECT_EQ(SmallVocabulary().Encode("teapod cup", 110), (std::vector<int>{2, 1, 8, 3}));
  EXPECT_EQ(SmallVocabulary().Encode(std::string(200, 'a'), 110), (std::vector<int>{2, 1, 3}));
}

TEST(WordPieces, CutsALongTextBeforeTheLastPiece) {
  std::string text;
  for (int i = 0; i < 10000; ++i) text += "cup ";
  const std::vector<int> ids = SmallVocabulary().Encode(text, 16);
  ASSERT_EQ(ids.size(), 16u);
  EXPECT_EQ(ids.front(), 2);
  EXPECT_EQ(ids[14], 8);
  EXPECT_EQ(ids.back(), 3);
}

TEST(WordPieces, LearnsTheMostFrequentPairsFirst) {
  // "ab" occurs 3 times, "##bc" twice, "cd" once: "ab" is merged first, and then "ab", "##c".
  const WordPieces pieces = WordPieces::Learn({"abc abc ab cd"}, 4 + 5 + 2);
  const std::vector<std::string> wanted = {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "##b", "##c",
                                           "##d",   "a",     "c",     "ab",    "abc"};
  EXPECT_EQ(pieces.pieces(), wanted);
}

TEST(WordPieces, WordsOfTheCorpusBecomeWholePieces) {
  const WordPieces pieces = WordPieces::Learn({"A scene with two apples and a bowl."}, 512);
  EXPECT_EQ(pieces.Encode("two apples", 110).size(), 4u);
  // Unseen words of seen characters are spelled, not unknown.
  const std::vector<int> ids = pieces.Encode("bow", 110);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), 1), 0);
  EXPECT_EQ(WordPieces::Learn({"A scene with two apples and a bowl."}, 512).pieces(),
            pieces.pieces());
}

TEST(WordPieces, ReadsAFileAndNamesItsFaults) {
  const core::TemporaryFolder folder;
  const auto file = folder.path() / "vocab.txt";
  core::WriteFile(file, "[PAD]\r\n[UNK]\r\n[CLS]\r\n[SEP]\r\ncup\r\n");
  EXPECT_EQ(WordPieces::Read(file).Encode("cup", 8), (std::vector<int>{2, 4, 3}));
  core::WriteFile(file, "[PAD]\n[UNK]\n[SEP]\ncup\n");
  EXPECT_THROW(WordPieces::Read(file), core::Error);
  core::WriteFile(file, "[PAD]\n[UNK]\n[CLS]\n[SEP]\ncup\ncup\n");
  EXPECT_THROW(WordPieces::Read(file), core::Error);
  EXPECT_THROW(WordPieces::Read(folder.path() / "none.txt"), core::Error);
  EXPECT_THROW(WordPieces::Learn({"abcdefgh"}, 4), core::Error);
}

}  // namespace
}  // namespace simwright::scene
