#include "scene/prompt/prompt_phrases.h"

#include <initializer_list>

#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

using Kind = PromptItemKind;
using PhraseTable = std::unordered_map<std::string, PromptItem>;
using PhraseList = std::initializer_list<const char*>;

PromptItem ItemOf(Kind kind) {
  PromptItem item;
  item.kind = kind;
  return item;
}

void AddPhrases(const PromptItem& item, PhraseList phrases, PhraseTable* table) {
  for (const char* phrase : phrases) {
    PromptItem entry = item;
    entry.words = phrase;
    table->insert_or_assign(phrase, entry);
  }
}

void AddRelation(Relation relation, PhraseList phrases, PhraseTable* table) {
  PromptItem item = ItemOf(Kind::kRelation);
  item.relation = relation;
  AddPhrases(item, phrases, table);
}

void AddRelations(PhraseTable* table) {
  AddRelation(Relation::kOn, {"on", "on top of", "on the top of", "upon", "atop", "onto"}, table);
  AddRelation(Relation::kAbove, {"above", "over", "higher than"}, table);
  AddRelation(Relation::kBelow, {"below", "under", "underneath", "beneath", "lower than"}, table);
  AddRelation(Relation::kInside, {"inside", "inside of", "in", "within", "into"}, table);
  AddRelation(Relation::kLeftOf,
              {"to the left of", "to the left side of", "on the left of", "on the left side of",
               "at the left of", "left of", "left from"},
              table);
  AddRelation(Relation::kRightOf,
              {"to the right of", "to the right side of", "on the right of", "on the right side of",
               "at the right of", "right of", "right from"},
              table);
  AddRelation(Relation::kInFrontOf, {"in front of", "in the front of", "before"}, table);
  AddRelation(Relation::kBehind, {"behind", "in back of"}, table);
  AddRelation(Relation::kNextTo,
              {"next to", "beside", "near", "near to", "nearby", "close to", "by", "adjacent to",
               "alongside"},
              table);
  AddRelation(Relation::kFacing,
              {"facing", "faces", "face", "turned to", "turned toward", "turned towards",
               "pointing at", "pointing to", "pointing towards", "oriented towards", "looking at"},
              table);
  PromptItem item = ItemOf(Kind::kRelation);
  item.reversed = true;
  item.relation = Relation::kInside;
  AddPhrases(item, {"contains", "containing", "holds", "holding", "full of", "filled with"}, table);
  item.relation = Relation::kOn;
  AddPhrases(item, {"carrying", "topped with"}, table);
  item.reversed = false;
  item.has_object = true;
  item.relation = Relation::kLeftOf;
  AddPhrases(item, {"to its left", "on its left"}, table);
  item.relation = Relation::kRightOf;
  AddPhrases(item, {"to its right", "on its right"}, table);
}

void AddTiers(PhraseTable* table) {
  const auto add = [&](ShelfTier tier, PhraseList adjectives) {
    PromptItem item = ItemOf(Kind::kTier);
    item.tier = tier;
    for (const std::string adjective : adjectives) {
      for (const std::string before : {"on the ", "in the ", "at the ", "on ", "onto the "}) {
        for (const char* board : {" shelf", " board", " tier", " level"}) {
          item.words = before + adjective + board;
          table->insert_or_assign(item.words, item);
        }
      }
    }
  };
  add(ShelfTier::kTop, {"top", "upper", "uppermost", "highest", "topmost"});
  add(ShelfTier::kSecond, {"second", "second highest"});
  add(ShelfTier::kThird, {"third"});
  add(ShelfTier::kBottom, {"bottom", "lowest", "lower", "lowermost", "fourth"});
}

void AddVague(int number, int total, PhraseList phrases, PhraseTable* table) {
  PromptItem item = ItemOf(Kind::kVague);
  item.number = number;
  item.total = total;
  AddPhrases(item, phrases, table);
}

void AddQuantities(PhraseTable* table) {
  AddVague(3, 5, {"some", "a few", "few", "a group of", "a stack of", "stacks of"}, table);
  AddVague(4, 8, {"several", "various", "a handful of", "a number of", "multiple", "a pile of"},
           table);
  AddVague(6, 20,
           {"many", "lots of", "a lot of", "plenty of", "loads of", "numerous", "a bunch of"},
           table);
  AddVague(24, 24, {"dozens of", "dozens"}, table);
  const auto number = [&](int value, PhraseList phrases) {
    PromptItem item = ItemOf(Kind::kNumber);
    item.number = value;
    AddPhrases(item, phrases, table);
  };
  number(1, {"a single", "single", "exactly one", "only one", "just one"});
  number(2, {"a couple of", "a couple", "couple of", "a pair of", "pair of"});
  number(4, {"two pairs of"});
  number(6, {"three pairs of", "half a dozen", "a half dozen"});
  number(12, {"a dozen", "dozen", "a dozen of"});
  number(24, {"two dozen"});
  number(36, {"three dozen"});
  AddPhrases(ItemOf(Kind::kNone), {"no", "without", "without any", "zero", "not any", "none of"},
             table);
  AddPhrases(ItemOf(Kind::kTotal),
             {"objects", "object", "things", "thing", "items", "item", "goods", "pieces"}, table);
  AddPhrases(ItemOf(Kind::kOthers),
             {"other objects", "other object", "other things", "other thing", "other items",
              "others", "and more", "more objects", "more things", "more items", "something else",
              "other stuff", "some more", "more", "etc", "and so on", "additional objects"},
             table);
  AddPhrases(ItemOf(Kind::kNoOthers),
             {"nothing else", "nothing more", "no other objects", "no other things", "no others",
              "no other items", "no more objects", "without other objects", "without others"},
             table);
  AddPhrases(ItemOf(Kind::kOneOf), {"one of the", "one of these", "any of the"}, table);
  for (int i = 1; i <= 20; ++i) {
    PromptItem item = ItemOf(Kind::kOrdinal);
    item.number = i;
    item.words = OrdinalWord(i);
    table->insert_or_assign(item.words, item);
  }
}

void AddFunctionWords(PhraseTable* table) {
  AddPhrases(ItemOf(Kind::kNot), {"not", "never"}, table);
  AddPhrases(ItemOf(Kind::kArticle), {"a", "an", "another", "a further", "an extra", "a new"},
             table);
  AddPhrases(ItemOf(Kind::kThe),
             {"the", "this", "that", "these", "those", "each", "every", "all", "its", "all the",
              "all of the"},
             table);
  AddPhrases(ItemOf(Kind::kPronoun), {"it", "them", "they"}, table);
  AddPhrases(ItemOf(Kind::kIs), {"is", "sits", "stands", "lies", "rests", "should be", "must be"},
             table);
  AddPhrases(ItemOf(Kind::kAre), {"are", "sit", "stand", "lie", "rest"}, table);
  AddPhrases(ItemOf(Kind::kThere),
             {"there is", "there are", "there should be", "there must be", "add", "include"},
             table);
  AddPhrases(ItemOf(Kind::kAnd), {"and", "plus", "as well as", "and also"}, table);
  AddPhrases(ItemOf(Kind::kOr), {"or", "nor", "or any"}, table);
  AddPhrases(ItemOf(Kind::kPlace),
             {"table",      "tables",      "tabletop",        "shelf",        "shelves",
              "scene",      "room",        "kitchen",         "floor",        "pantry",
              "restaurant", "living room", "breakfast table", "dining table", "image",
              "picture",    "photo",       "middle",          "center",       "centre",
              "corner",     "foreground",  "background",      "edge",         "row",
              "line",       "total"},
             table);
  AddPhrases(ItemOf(Kind::kFiller),
             {"can you", "can we", "can i", "you can", "we can", "i can", "on it is", "such as",
              "as in", "in it is", "along with", "together with", "by the way"},
             table);
}

const std::unordered_set<std::string>& FillerWords() {
  static const std::unordered_set<std::string> words = {
      "with",       "of",          "for",       "to",          "at",         "from",
      "which",      "where",       "who",       "i",           "me",         "my",
      "you",        "your",        "we",        "us",          "our",        "want",
      "wants",      "need",        "like",      "would",       "could",      "should",
      "shall",      "will",        "please",    "make",        "makes",      "create",
      "generate",   "give",        "show",      "put",         "place",      "places",
      "placed",     "set",         "setting",   "have",        "has",        "having",
      "had",        "be",          "been",      "being",       "was",        "were",
      "do",         "does",        "so",        "as",          "if",         "then",
      "but",        "also",        "too",       "only",        "just",       "exactly",
      "about",      "around",      "at",        "least",       "most",       "consists",
      "consisting", "including",   "includes",  "included",    "among",      "standing",
      "sitting",    "lying",       "resting",   "located",     "positioned", "arranged",
      "left",       "right",       "front",     "back",        "top",        "bottom",
      "side",       "there",       "here",      "up",          "down",       "out",
      "off",        "some",        "any",       "other",       "same",       "different",
      "own",        "arrangement", "layout",    "composition", "view",       "breakfast",
      "dinner",     "lunch",       "meal",      "furniture",   "house",      "home",
      "world",      "space",       "area",      "kind",        "kinds",      "type",
      "types",      "lot",         "number",    "amount",      "group",      "people",
      "person",     "persons",     "am",        "say",         "let",        "stuff",
      "everything", "anything",    "something", "nothing",     "empty",      "full",
      "big",        "large",       "small",     "little",      "nice",       "dim",
      "sum",        "dimsum",      "clutter",   "cluttered",   "per",        "than",
      "both",       "stack",       "stacks",    "pile",        "piles",      "their",
      "his",        "her",         "one",       "ones",        "what",       "whose",
      "while"};
  return words;
}

}  // namespace

const std::unordered_map<std::string, PromptItem>& PromptPhrases() {
  static const PhraseTable phrases = [] {
    PhraseTable table;
    AddRelations(&table);
    AddTiers(&table);
    AddQuantities(&table);
    AddFunctionWords(&table);
    return table;
  }();
  return phrases;
}

const std::unordered_map<std::string, int>& NumberWords() {
  static const std::unordered_map<std::string, int> words = [] {
    std::unordered_map<std::string, int> table;
    for (int i = 0; i < 20; ++i) table[NumberWord(i)] = i;
    int value = 20;
    for (const char* tens :
         {"twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"}) {
      table[tens] = value;
      value += 10;
    }
    return table;
  }();
  return words;
}

bool IsFillerWord(const std::string& word) {
  return FillerWords().contains(word) || word.size() == 1;
}

}  // namespace simwright::scene
