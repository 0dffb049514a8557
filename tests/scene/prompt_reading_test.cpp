// Free text: counts, names, statements; contradictions, unknown words, garbage.
#include "scene/prompt/prompt_reading.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "physics_params/wordnet.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

using physics_params::WordNet;

const std::vector<std::string>& ReadingNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [category, size] : DefaultCategorySizes()) {
      if (category.starts_with("table") || category.starts_with("shelf") || category == "floor") {
        continue;
      }
      all.push_back(NameOfCategory(category));
    }
    return all;
  }();
  return names;
}

PromptReading Reading(const std::string& text) {
  return ReadPrompt(text, ReadingNames(), WordNet::Installed());
}

std::string Canonical(const std::string& text) {
  return Reading(text).text;
}

std::string ErrorOf(const std::string& text) {
  try {
    return "no error: " + Canonical(text);
  } catch (const core::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
}

bool HasFinding(const PromptReading& reading, const std::string& code, const std::string& words) {
  for (const core::Finding& one : reading.findings) {
    if (one.code == code && one.sentence.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(ReadPrompt, CountsAndNames) {
  EXPECT_EQ(Canonical("12 objects"), "A scene with 12 objects.");
  EXPECT_EQ(Canonical("Give me a scene with twelve things!"), "A scene with 12 objects.");
  EXPECT_EQ(Canonical("one hundred and twenty items"), "A scene with 120 objects.");
  EXPECT_EQ(Canonical("a dozen objects on a table"), "A scene with 12 objects.");
  EXPECT_EQ(Canonical("2 apples, a bowl & a fork"), "A scene with two apples, a bowl, and a fork.");
  EXPECT_EQ(Canonical("KNIVES: 3 knives, twenty-one forks"),
            "A scene with six knives and 21 forks.");
  EXPECT_EQ(Canonical("a couple of mugs and a pair of teaspoons"),
            "A scene with two mugs and two teaspoons.");
  EXPECT_EQ(Canonical("toast, two pieces of toast"), "A scene with three slices of toast.");
  EXPECT_EQ(Canonical("an apple_2 and tea_bottle"), "A scene with an apple and a tea bottle.");
  EXPECT_EQ(Canonical("a steamer lid and a steamer"), "A scene with a steamer lid and a steamer.");
  EXPECT_EQ(Canonical("an apple, two cups and some other objects"),
            "A scene with an apple, two cups, and some other objects.");
  EXPECT_EQ(Canonical("an apple and more"), "A scene with an apple and some other objects.");
  EXPECT_EQ(Canonical("Can you make a scene with two cups?"), "A scene with two cups.");
  EXPECT_EQ(Canonical("I'd like a crowded scene that has cups"), "A scene with three cups.");
  EXPECT_EQ(Canonical("a kitchen table without cups and plates, with a fork"),
            "A scene with no cups, no plates, and a fork.");
  EXPECT_EQ(Canonical("no cups"), "A scene with no cups and some other objects.");
  EXPECT_EQ(Canonical("no cups and nothing else"), "A scene with 0 objects: no cups.");
  EXPECT_EQ(Canonical("no objects"), "A scene with 0 objects.");
  EXPECT_EQ(Canonical("12 objects, among them three cups"),
            "A scene with 12 objects: three cups and some other objects.");
  EXPECT_EQ(Canonical("three cups and 4 other objects"),
            "A scene with 7 objects: three cups and some other objects.");
  EXPECT_EQ(Canonical("3 objects: three cups"), "A scene with 3 objects: three cups.");
  EXPECT_EQ(Reading(" \n\t ").prompt.kind, PromptKind::kEmpty);
  EXPECT_EQ(Canonical(""), "");
}

TEST(ReadPrompt, ItsOwnWordingForCountsWithNames) {
  for (const char* text : {"A scene with 12 objects: three cups and some other objects.",
                           "A scene with two apples and no cups.", "A scene with 0 objects.",
                           "A scene with 1 object.", "A scene with 3 objects: three cups.",
                           "A scene with two apples and a bowl. One of the apples is inside the "
                           "bowl."}) {
    EXPECT_EQ(Canonical(text), text);
    EXPECT_TRUE(Reading(text).findings.empty()) << text;
  }
}

TEST(ReadPrompt, ChosenNumbersAreNotes) {
  EXPECT_EQ(Canonical("several apples"), "A scene with four apples.");
  EXPECT_TRUE(HasFinding(Reading("two shelves and a mug"), "prompt-furniture", "two shelves"));
  EXPECT_TRUE(HasFinding(Reading("no table and a mug"), "prompt-furniture", "no table"));
  EXPECT_FALSE(HasFinding(Reading("a mug on a table"), "prompt-furniture", ""));
  EXPECT_TRUE(HasFinding(Reading("lots of mugs"), "prompt-number-chosen", "six mugs"));
  EXPECT_TRUE(HasFinding(Reading("apples"), "prompt-number-chosen", "three apples"));
  EXPECT_TRUE(HasFinding(Reading("a mug between two bowls"), "prompt-word-ignored", "between"));
  EXPECT_EQ(Canonical("many objects"), "A scene with 20 objects.");
  EXPECT_TRUE(HasFinding(Reading("a mug and a mug"), "prompt-repeated-name", "mugs"));
}

TEST(ReadPrompt, ReferencesAreNotAskedFor) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(Reading("an apple to the left of the bowl").referred, Names{"bowl"});
  EXPECT_EQ(Reading("an apple and a bowl; the apple is in the bowl").referred, Names{});
  EXPECT_EQ(Reading("two apples behind the second mug").referred, Names{"mug"});
  EXPECT_EQ(Reading("another bowl").referred, Names{});
}

TEST(ReadPrompt, Statements) {
  const std::string both = "A scene with an apple and a bowl. The apple is ";
  for (const auto& [words, relation] :
       std::vector<std::pair<std::string, std::string>>{{"left of", "to the left of"},
                                                        {"to the left of", "to the left of"},
                                                        {"on the right side of", "to the right of"},
                                                        {"on top of", "on"},
                                                        {"on", "on"},
                                                        {"in", "inside"},
                                                        {"inside", "inside"},
                                                        {"in front of", "in front of"},
                                                        {"next to", "next to"},
                                                        {"beside", "next to"},
                                                        {"near", "next to"},
                                                        {"under", "below"},
                                                        {"above", "above"},
                                                        {"behind", "behind"},
                                                        {"facing", "facing"}}) {
    EXPECT_EQ(Canonical("an apple " + words + " a bowl"), both + relation + " the bowl.");
    EXPECT_EQ(Canonical("An apple and a bowl. The apple is " + words + " the bowl."),
              both + relation + " the bowl.");
  }
  EXPECT_EQ(Canonical("a bowl containing an apple"),
            "A scene with a bowl and an apple. The apple is inside the bowl.");
  EXPECT_EQ(Canonical("a bowl with an apple in it"),
            "A scene with a bowl and an apple. The apple is inside the bowl.");
  EXPECT_EQ(Canonical("On the plate is an apple."),
            "A scene with a plate and an apple. The apple is on the plate.");
  EXPECT_EQ(Canonical("a plate with a cup to its left"),
            "A scene with a plate and a cup. The cup is to the left of the plate.");
  EXPECT_EQ(Canonical("An apple, a bowl and a cup; the apple is left of the bowl and behind the "
                      "cup."),
            "A scene with an apple, a bowl, and a cup. The apple is to the left of the bowl. The "
            "apple is behind the cup.");
  EXPECT_EQ(Canonical("two apples on a plate"),
            "A scene with two apples and a plate. The first apple is on the plate. The second "
            "apple is on the plate.");
  EXPECT_EQ(Canonical("The second apple is next to the mug"),
            "A scene with two apples, a mug, and some other objects. The second apple is next to "
            "the mug.");
  EXPECT_EQ(Canonical("a can on the top shelf and a pear on the lowest shelf"),
            "A scene with a can and a pear. The can is on the top shelf. The pear is on the bottom "
            "shelf.");
  EXPECT_EQ(Canonical("On the second shelf there are two cans"),
            "A scene with two cans. The first can is on the second shelf. The second can is on the "
            "second shelf.");
  EXPECT_EQ(Canonical("a mug on the table"), "A scene with a mug.");
  EXPECT_TRUE(HasFinding(Reading("The mug is not on the plate"), "prompt-statement-ignored", "on"));
}

TEST(ReadPrompt, StatementsThatAreLeftOutAreSaid) {
  EXPECT_TRUE(HasFinding(Reading("an apple on the ninth shelf"), "prompt-furniture", "ninth"));
  EXPECT_TRUE(
      HasFinding(Reading("the apple is inside the apple"), "prompt-statement-ignored", "itself"));
  EXPECT_FALSE(HasFinding(Reading("an apple on the top shelf"), "prompt-furniture", ""));
}

TEST(ReadPrompt, Synonyms) {
  if (WordNet::Installed() == nullptr) GTEST_SKIP() << "wordnet-base is not installed";
  EXPECT_EQ(Canonical("two soda cans"), "A scene with two cans.");
  EXPECT_EQ(Canonical("a soup bowl"), "A scene with a bowl.");
  EXPECT_EQ(Canonical("a fruit bowl"), "A scene with a bowl.");  // no fruit
  EXPECT_EQ(Canonical("three coffee mugs"), "A scene with three mugs.");
  EXPECT_EQ(Canonical("a red apple"), "A scene with an apple.");
  EXPECT_EQ(Canonical("a bottle"), "A scene with a tea bottle.");
  EXPECT_EQ(Canonical("two flasks"), "A scene with two tea bottles.");
  EXPECT_EQ(Canonical("a beer mug"), "A scene with a mug.");
  EXPECT_TRUE(HasFinding(Reading("a bottle"), "prompt-synonym", "tea bottle"));
}

TEST(ReadPrompt, UnknownObjectsNameTheNearest) {
  const PromptReading reading = Reading("two apples, a zebra and a cup");
  EXPECT_EQ(reading.text, "A scene with two apples and a cup.");
  EXPECT_TRUE(HasFinding(reading, "prompt-unknown-object", "\"zebra\""));
  EXPECT_EQ(Canonical("a cup next to a zebra"), "A scene with a cup.");
  const PromptReading typo = ReadPrompt("a cup and an aple", ReadingNames(), nullptr);
  EXPECT_TRUE(HasFinding(typo, "prompt-unknown-object", "apple"));
  if (WordNet::Installed() == nullptr) return;
  const PromptReading pie = Reading("a cup and an apple pie");
  EXPECT_EQ(pie.text, "A scene with a cup.");
  EXPECT_TRUE(HasFinding(pie, "prompt-unknown-object", "apple pie"));
  const PromptReading goblet = Reading("a cup and a banana");
  EXPECT_TRUE(HasFinding(goblet, "prompt-unknown-object", "pear")) << goblet.findings[0].sentence;
}

TEST(ReadPrompt, NoObjectsContradictUnknownOnesThatAreAskedFor) {
  const std::string error = ErrorOf("no objects and three dragons");
  EXPECT_NE(error.find("contradicts \"three dragons\""), std::string::npos) << error;
  EXPECT_EQ(Canonical("no objects"), "A scene with 0 objects.");
}

TEST(ReadPrompt, ContradictionsNameBothParts) {
  const auto names = [](const std::string& text, const std::string& one, const std::string& other) {
    const std::string error = ErrorOf(text);
    EXPECT_NE(error.find("\"" + one + "\""), std::string::npos) << error;
    EXPECT_NE(error.find("\"" + other + "\""), std::string::npos) << error;
  };
  names("no objects and three cups", "no objects", "three cups");
  names("three cups and no cups", "no cups", "three cups");
  names("5 objects: three cups and four forks", "5 objects", "three cups");
  names("12 objects, 15 objects", "12 objects", "15 objects");
  names("an apple and a bowl. The apple is left of the bowl. The bowl is left of the apple.",
        "the apple is to the left of the bowl", "the bowl is to the left of the apple");
  names("a can. The can is on the top shelf. The can is on the bottom shelf.",
        "the can is on the top shelf", "the can is on the bottom shelf");
  names("A scene with an apple. The third apple is next to a mug.", "an apple", "the third apple");
}

TEST(ReadPrompt, BadTextsAreErrors) {
  EXPECT_NE(ErrorOf("ein Tisch mit zwei Tellern").find("apple"), std::string::npos);
  EXPECT_NE(ErrorOf("dos platos y un tenedor").find("nothing in the prompt"), std::string::npos);
  EXPECT_NE(ErrorOf("\xe4\xb8\xa4\xe4\xb8\xaa\xe8\x8b\xb9\xe6\x9e\x9c").find("English"),
            std::string::npos);
  EXPECT_NE(ErrorOf("a zebra").find("nearest to \"zebra\""), std::string::npos);
  EXPECT_NE(ErrorOf("a\x01 cup").find("control"), std::string::npos);
  EXPECT_NE(ErrorOf("a \xff cup").find("UTF-8"), std::string::npos);
  EXPECT_NE(ErrorOf("a \xed\xa0\x80 cup").find("UTF-8"), std::string::npos);
  EXPECT_NE(ErrorOf("2.5 cups").find("2.5"), std::string::npos);
  EXPECT_NE(ErrorOf("-3 cups").find("-3"), std::string::npos);
  EXPECT_NE(ErrorOf("99999999999999999999 cups").find("number"), std::string::npos);
  EXPECT_NE(ErrorOf("900000th cup is on the plate").find("ordinal"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(5000, 'a')).find("100 bytes"), std::string::npos);
  std::string many;
  for (int i = 0; i < 10000; ++i) many += "cup ";
  EXPECT_NE(ErrorOf(many).find("2000 words"), std::string::npos);
}

TEST(ReadPrompt, TooManyForTheVocabularyIsAWarning) {
  const Vocabulary vocabulary{"test", 4, {"bowl", "cup", "table"}, {false, false, true}};
  const PromptReading reading = ReadPrompt("five cups", vocabulary, nullptr);
  EXPECT_TRUE(HasFinding(reading, "prompt-too-many", "at most 4"));
  EXPECT_TRUE(ReadPrompt("four cups", vocabulary, nullptr).findings.empty());
}

// Random bytes and random words of the vocabulary: a valid prompt that is read back, or an error.
TEST(ReadPrompt, GarbageIsAPromptOrAnError) {
  const std::vector<std::string> words = {
      "a",       "an",    "the",     "two",        "no",  "apple", "cups", "plate", "on",
      "left",    "of",    "is",      "are",        "and", ",",     ".",    "it",    "second",
      "without", "other", "objects", "12",         "in",  "next",  "to",   "top",   "shelf",
      "zebra",   "not",   "some",    "containing", "or",  "there", "its",  "one",   "more"};
  core::Rng rng(17);
  int read = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text;
    const auto length = core::UniformIndex(rng, 40);
    for (std::int64_t k = 0; k < length; ++k) {
      if (i % 4 == 0) {
        text += static_cast<char>(core::UniformIndex(rng, 256));
      } else {
        text += words[static_cast<size_t>(
                    core::UniformIndex(rng, static_cast<std::int64_t>(words.size())))] +
                " ";
      }
    }
    try {
      const PromptReading reading = ReadPrompt(text, ReadingNames(), WordNet::Installed());
      std::string error;
      ASSERT_TRUE(reading.prompt.IsValid(&error)) << text << ": " << error;
      ASSERT_EQ(reading.text, reading.prompt.Text());
      const PromptReading again = ReadPrompt(reading.text, ReadingNames(), WordNet::Installed());
      ASSERT_EQ(again.text, reading.text) << text;
      ++read;
    } catch (const core::Error& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(read, 600);
}

}  // namespace
}  // namespace simwright::scene
