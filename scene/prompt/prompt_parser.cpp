#include "scene/prompt/prompt_parser.h"

#include <algorithm>

#include "core/error.h"
#include "scene/prompt/mention_resolution.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {
namespace {

using Kind = PromptItemKind;

constexpr size_t kMostStatements = 200;  // per prompt

// A relation whose object has not been read yet.
struct OpenRelation {
  PromptItem item;
  Mention subject;
  bool inverted = false;  // "on the plate is ...": the object comes before the subject
  bool ignored = false;   // its subject is not known, or it is negated
  Mention object;         // of an inverted relation
};

class PromptParser {
 public:
  PromptParser(const std::vector<PromptItem>& items, const NameLookup& lookup)
      : items_(items), lookup_(lookup) {}

  ParsedPrompt Parse() {
    BeginSentence();
    while (at_ < items_.size()) Read(items_[at_]);
    return std::move(parsed_);
  }

 private:
  // Each of these reads the item at `at_` and advances it.
  void Read(const PromptItem& item);
  void ReadQuantity(const PromptItem& item);
  void ReadName(const PromptItem& item);
  void ReadTotal(const PromptItem& item);
  void ReadOthers(const PromptItem& item);
  void ReadRelation(const PromptItem& item);
  void ReadTier(const PromptItem& item);
  void ReadPronoun();
  void ReadJoint(const PromptItem& item);
  void ReadUnknown();

  void BeginSentence();
  Mention SubjectOfStatement() const;
  void CloseRelation(const Mention& object);
  void AddRelations(const Mention& subject, const PromptItem& relation, const Mention& object);
  void AddTiers(const Mention& subject, ShelfTier tier);
  void NoteFurniture(const PromptItem& item);
  void Note(const char* code, core::Severity severity, const std::string& sentence) {
    AddPromptNote(code, severity, sentence, &parsed_.findings);
  }
  bool NextIs(Kind kind) const { return at_ + 1 < items_.size() && items_[at_ + 1].kind == kind; }
  void Drop() { quantity_ = {}; }

  const std::vector<PromptItem>& items_;
  const NameLookup& lookup_;
  size_t at_ = 0;
  ParsedPrompt parsed_;
  MentionQuantity quantity_;
  bool none_ = false, without_ = false, not_ = false;
  std::string none_words_;
  bool statement_ = false;        // this sentence says where objects are
  Mention mention_, previous_;    // the last two mentions of the sentence
  Mention joined_;                // all mentions since the last statement
  Mention last_subject_;          // of the last statement
  bool are_ = false;              // "are" was read after joined_
  bool closed_ = false;           // a statement was completed by the last mention
  bool continued_ = false;        // and "and" or a comma follows
  bool unknown_subject_ = false;  // the last mention was of an unknown object
  std::optional<OpenRelation> open_;
  std::optional<PromptItem> closed_relation_;
  std::optional<ShelfTier> open_tier_;  // "on the top shelf there are ..."
};

void PromptParser::BeginSentence() {
  quantity_ = {};
  none_ = without_ = not_ = are_ = closed_ = continued_ = unknown_subject_ = false;
  mention_.clear();
  previous_.clear();
  joined_.clear();
  open_.reset();
  open_tier_.reset();
  statement_ = false;
  bool is = false, related = false;
  for (size_t i = at_; i < items_.size() && items_[i].kind != Kind::kStop; ++i) {
    is = is || items_[i].kind == Kind::kIs || items_[i].kind == Kind::kAre;
    related = related || items_[i].kind == Kind::kRelation || items_[i].kind == Kind::kTier;
    if (items_[i].kind == Kind::kThere) return;
  }
  statement_ = is && related;
}

void PromptParser::Read(const PromptItem& item) {
  switch (item.kind) {
    case Kind::kName:
      return ReadName(item);
    case Kind::kTotal:
      return ReadTotal(item);
    case Kind::kOthers:
    case Kind::kNoOthers:
      return ReadOthers(item);
    case Kind::kRelation:
      return ReadRelation(item);
    case Kind::kTier:
      return ReadTier(item);
    case Kind::kPronoun:
      return ReadPronoun();
    case Kind::kUnknown:
      return ReadUnknown();
    case Kind::kNumber:
    case Kind::kVague:
    case Kind::kNone:
    case Kind::kNot:
    case Kind::kArticle:
    case Kind::kThe:
    case Kind::kOneOf:
    case Kind::kOrdinal:
      return ReadQuantity(item);
    default:
      return ReadJoint(item);
  }
}

void PromptParser::ReadQuantity(const PromptItem& item) {
  quantity_.words += (quantity_.words.empty() ? "" : " ") + item.words;
  if (item.kind == Kind::kNumber && item.number > 0) quantity_.number = item.number;
  if (item.kind == Kind::kVague) quantity_.vague = item;
  if (item.kind == Kind::kNot) not_ = true;
  // "a scene that has cups": no determiner.
  const bool relative = item.words == "that" && (NextIs(Kind::kFiller) || NextIs(Kind::kThere));
  if (item.kind == Kind::kThe && !relative) quantity_.definite = true;
  if (item.kind == Kind::kOneOf) quantity_.one_of = true;
  if (item.kind == Kind::kOrdinal) quantity_.ordinal = item.number;
  if (item.kind == Kind::kArticle) {
    quantity_.article = true;
    quantity_.another = item.words.size() > 2;
  }
  if (item.kind == Kind::kNone || (item.kind == Kind::kNumber && item.number == 0)) {
    none_ = true;
    without_ = item.words.starts_with("without");
    none_words_ = item.words;
  }
  ++at_;
}

// Reads what joins mentions, and words that only end a list.
void PromptParser::ReadJoint(const PromptItem& item) {
  ++at_;
  switch (item.kind) {
    case Kind::kStop:
      BeginSentence();
      break;
    case Kind::kAnd:
    case Kind::kComma:
      if (!(without_ && at_ < items_.size() && items_[at_].kind == Kind::kName)) none_ = false;
      continued_ = continued_ || closed_;
      if (item.kind == Kind::kComma) Drop();
      break;
    case Kind::kAre:
      are_ = true;
      break;
    case Kind::kPlace:
      NoteFurniture(item);
      if (open_) {
        last_subject_ = open_->subject;
        closed_ = true;
        closed_relation_.reset();
        open_.reset();
      }
      Drop();
      break;
    default:
      break;
  }
}

void PromptParser::ReadName(const PromptItem& item) {
  const std::string& name = lookup_.names()[static_cast<size_t>(item.match.name)];
  // "apple pie": the second word is the object.
  if (!item.match.plural && NextIs(Kind::kUnknown) &&
      lookup_.IsPhysicalNoun(items_[at_ + 1].words)) {
    return ReadUnknown();
  }
  if (!item.match.exact) {
    Note("prompt-synonym", core::Severity::kInfo,
         "\"" + item.words + "\" is read as \"" + name + "\"");
  }
  ++at_;
  if (none_ || (not_ && !open_)) {
    MentionedName& state = MentionedNameOf(item.match.name, &parsed_);
    state.none = true;
    state.none_words = (none_ ? none_words_ : "not") + " " + item.words;
    Drop();
    mention_.clear();
    return;
  }
  const bool definite = quantity_.definite || quantity_.ordinal > 0;
  Mention mention = MentionResolver(lookup_, statement_, &parsed_).Resolve(quantity_, item);
  Drop();
  unknown_subject_ = false;
  if (open_ && !open_->inverted) return CloseRelation(mention);
  if (open_ && open_->object.empty()) {
    open_->object = mention;
  } else if (open_) {
    AddRelations(mention, open_->item, open_->object);
  }
  const bool is_subject = at_ < items_.size() &&
                          (items_[at_].kind == Kind::kIs || items_[at_].kind == Kind::kAre ||
                           items_[at_].kind == Kind::kRelation || items_[at_].kind == Kind::kTier);
  if (continued_ && closed_relation_ && definite && !is_subject) {
    // "next to the plate and the bowl"
    AddRelations(last_subject_, *closed_relation_, mention);
    return;
  }
  if (open_tier_) AddTiers(mention, *open_tier_);
  closed_ = continued_ = are_ = false;
  previous_ = std::move(mention_);
  mention_ = mention;
  joined_.insert(joined_.end(), mention.begin(), mention.end());
}

void PromptParser::ReadTotal(const PromptItem& item) {
  ++at_;
  std::optional<int> total = quantity_.number;
  if (none_) total = 0;
  const bool singular = !item.words.ends_with("s");
  if (!total && quantity_.article && singular) total = 1;
  if (!total && quantity_.vague && !singular) {
    total = quantity_.vague->total;
    Note("prompt-number-chosen", core::Severity::kInfo,
         "\"" + quantity_.words + " " + item.words + "\" is read as " + std::to_string(*total) +
             " objects");
  }
  const std::string words = quantity_.words + " " + item.words;
  none_ = false;
  Drop();
  mention_.clear();
  open_.reset();
  if (!total) return;
  if (parsed_.total && *parsed_.total != *total) {
    throw core::Error("\"" + parsed_.total_words + "\" contradicts \"" + words + "\"", "prompt",
                      "state one number of objects");
  }
  parsed_.total = total;
  parsed_.total_words = words;
}

void PromptParser::ReadOthers(const PromptItem& item) {
  ++at_;
  const bool before_name = at_ < items_.size() && items_[at_].kind == Kind::kName;
  if (before_name && item.words.ends_with("more")) return;  // "two more apples"
  if (item.kind == Kind::kNoOthers || none_) {
    parsed_.no_others = true;
  } else {
    parsed_.others = true;
    if (quantity_.number) parsed_.other_count += *quantity_.number;
  }
  none_ = false;
  Drop();
  open_.reset();
}

Mention PromptParser::SubjectOfStatement() const {
  if (continued_) return last_subject_;
  return are_ ? joined_ : mention_;
}

void PromptParser::ReadRelation(const PromptItem& item) {
  ++at_;
  const Mention subject = SubjectOfStatement();
  const bool negated = not_;
  not_ = false;
  Drop();
  if (item.has_object) {
    if (!negated) AddRelations(mention_, item, previous_);
    return;
  }
  OpenRelation open;
  open.item = item;
  open.subject = subject;
  open.ignored = negated || unknown_subject_;
  open.inverted = subject.empty() && !open.ignored;
  if (negated) {
    Note("prompt-statement-ignored", core::Severity::kWarning,
         "a negated statement (\"not " + item.words + "\") is not understood and ignored");
  }
  open_ = std::move(open);
}

void PromptParser::CloseRelation(const Mention& object) {
  const OpenRelation open = std::move(*open_);
  open_.reset();
  if (!open.ignored) AddRelations(open.subject, open.item, object);
  last_subject_ = open.subject;
  closed_relation_ = open.item;
  closed_ = !open.ignored;
  continued_ = are_ = false;
  joined_.clear();
  previous_ = open.subject;
  mention_ = object;
}

void PromptParser::ReadTier(const PromptItem& item) {
  ++at_;
  const Mention subject = SubjectOfStatement();
  if (not_) {
    Note("prompt-statement-ignored", core::Severity::kWarning,
         "a negated statement (\"not " + item.words + "\") is not understood and ignored");
  } else if (subject.empty() && !unknown_subject_) {
    open_tier_ = item.tier;
  } else {
    AddTiers(subject, item.tier);
  }
  not_ = false;
  Drop();
  last_subject_ = subject;
  closed_relation_.reset();
  closed_ = true;
  continued_ = are_ = false;
  joined_.clear();
}

void PromptParser::ReadPronoun() {
  ++at_;
  if (open_ && !open_->inverted) {
    const Mention object = open_->subject == mention_ ? previous_ : mention_;
    return CloseRelation(object);
  }
  if (mention_.empty()) mention_ = last_subject_;
  joined_ = mention_;
}

// Reads a run of unknown words, or a known name that is part of a longer one.
void PromptParser::ReadUnknown() {
  std::string words;
  bool physical = false;
  for (; at_ < items_.size(); ++at_) {
    const PromptItem& item = items_[at_];
    const bool part = words.empty() || item.kind == Kind::kUnknown;
    if (!part) break;
    words += (words.empty() ? "" : " ") + item.words;
    physical = physical || lookup_.IsPhysicalNoun(item.words);
  }
  if (at_ < items_.size() && items_[at_].kind == Kind::kName) {
    Note("prompt-word-ignored", core::Severity::kInfo,
         "\"" + words + "\" before \"" + items_[at_].words + "\" is ignored");
    return;
  }
  const bool before_place =
      at_ < items_.size() && (items_[at_].kind == Kind::kPlace || items_[at_].kind == Kind::kTotal);
  if (before_place || (!physical && !quantity_.Any() && !none_)) {
    parsed_.ignored.push_back(words);
    return;
  }
  parsed_.unknown.push_back(words);
  if (!none_ && !not_ && quantity_.Any() && parsed_.unknown_asked.empty()) {
    parsed_.unknown_asked = (quantity_.words.empty() ? "" : quantity_.words + " ") + words;
  }
  if (open_) open_->ignored = true;
  open_.reset();
  unknown_subject_ = true;
  mention_.clear();
  Drop();
}

// Says that a number of tables or shelves has no effect: they belong to the scene type.
void PromptParser::NoteFurniture(const PromptItem& item) {
  const bool furniture = item.words.starts_with("table") || item.words.starts_with("shel");
  const bool counted =
      none_ || quantity_.ordinal > 0 || (quantity_.number && *quantity_.number != 1);
  if (!furniture || !counted) return;
  const std::string words = (none_ ? none_words_ : quantity_.words) + " " + item.words;
  Note("prompt-furniture", core::Severity::kWarning,
       "\"" + words + "\" is ignored: furniture belongs to the scene type");
}

void PromptParser::AddRelations(const Mention& subject, const PromptItem& relation,
                                const Mention& object) {
  if (subject == object && subject.size() == 1) {
    Note("prompt-statement-ignored", core::Severity::kWarning,
         "an object \"" + relation.words + "\" itself is ignored; write \"another\" for two");
  }
  for (const MentionedObject& a : relation.reversed ? object : subject) {
    for (const MentionedObject& b : relation.reversed ? subject : object) {
      const MentionedRelation one{a, relation.relation, b};
      const auto& all = parsed_.relations;
      const bool known = std::find(all.begin(), all.end(), one) != all.end();
      if (a == b || known || all.size() >= kMostStatements) continue;
      parsed_.relations.push_back(one);
    }
  }
}

void PromptParser::AddTiers(const Mention& subject, ShelfTier tier) {
  for (const MentionedObject& a : subject) {
    const MentionedTier one{a, tier};
    const auto& all = parsed_.tiers;
    const bool known = std::find(all.begin(), all.end(), one) != all.end();
    if (!known && all.size() < kMostStatements) parsed_.tiers.push_back(one);
  }
}

}  // namespace

ParsedPrompt ParsePrompt(const std::vector<PromptItem>& items, const NameLookup& lookup) {
  return PromptParser(items, lookup).Parse();
}

}  // namespace simwright::scene
