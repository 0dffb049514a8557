// The methods of strings, and str(x).
#include <algorithm>
#include <cctype>

#include "reward/stdlib/format_text.h"
#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

constexpr std::size_t kLongestString = 4096;

const std::string& TextArgument(const Arguments& arguments, std::size_t i) {
  if (!arguments[i].Is(ValueKind::kString)) {
    Fail("type", arguments.Place(i),
         "'" + arguments.called + "' wants a string here, this is " + Describe(arguments[i]));
  }
  return arguments[i].text;
}

Value Bounded(std::string text, Position position) {
  if (text.size() > kLongestString) {
    Fail("too-large", position, "the string is longer than 4096 characters");
  }
  return StringValue(std::move(text));
}

Value Text(Elaborator&, const Arguments& arguments) {
  return StringValue(FormatValue(arguments[0], "", '\0', arguments.Place(0)));
}

enum Case { kUpper, kLower, kCapital };

Value Recased(Elaborator&, const Arguments& arguments) {
  std::string text = TextArgument(arguments, 0);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const int variant = arguments.function->variant;
    const bool upper = variant == kUpper || (variant == kCapital && i == 0);
    if (c < 0x80) text[i] = static_cast<char>(upper ? std::toupper(c) : std::tolower(c));
  }
  return StringValue(std::move(text));
}

// Implements startswith and endswith (variant 1) with one string, or a tuple of them.
Value Affix(Elaborator& elaborator, const Arguments& arguments) {
  const std::string& text = TextArgument(arguments, 0);
  std::vector<Value> wanted = {arguments[1]};
  if (arguments[1].Is(ValueKind::kTuple)) {
    wanted = elaborator.Items(arguments[1], arguments.Place(1));
  }
  bool found = false;
  for (const Value& one : wanted) {
    if (!one.Is(ValueKind::kString)) TextArgument(arguments, 1);
    found = found || (arguments.function->variant == 1 ? text.ends_with(one.text)
                                                       : text.starts_with(one.text));
  }
  return BoolValue(found);
}

Value Replace(Elaborator&, const Arguments& arguments) {
  const std::string& text = TextArgument(arguments, 0);
  const std::string& old = TextArgument(arguments, 1);
  const std::string& fresh = TextArgument(arguments, 2);
  if (old.empty()) Fail("arguments", arguments.Place(1), "what is to be replaced is empty");
  std::string result;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(old, at)) != std::string::npos; at = next + old.size()) {
    result += text.substr(at, next - at) + fresh;
    if (result.size() > kLongestString) break;  // rejected below
  }
  return Bounded(result + text.substr(at), arguments.position);
}

// Implements strip, lstrip (1) and rstrip (2) of blanks, or of the given characters.
Value Strip(Elaborator&, const Arguments& arguments) {
  const std::string& text = TextArgument(arguments, 0);
  const std::string blanks = arguments.given[1] ? TextArgument(arguments, 1) : " \t\r\n";
  const std::size_t first = arguments.function->variant == 2 ? 0 : text.find_first_not_of(blanks);
  if (first == std::string::npos) return StringValue("");
  const std::size_t last =
      arguments.function->variant == 1 ? text.size() - 1 : text.find_last_not_of(blanks);
  if (last == std::string::npos || text.empty()) return StringValue("");
  return StringValue(text.substr(first, last - first + 1));
}

Value SplitText(Elaborator& elaborator, const Arguments& arguments) {
  const std::string& text = TextArgument(arguments, 0);
  const std::string& separator = TextArgument(arguments, 1);
  if (separator.empty()) Fail("arguments", arguments.Place(1), "the separator is empty");
  std::vector<Value> parts;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(separator, at)) != std::string::npos;
       at = next + separator.size()) {
    parts.push_back(StringValue(text.substr(at, next - at)));
  }
  parts.push_back(StringValue(text.substr(at)));
  return elaborator.NewList(std::move(parts));
}

Value JoinTexts(Elaborator& elaborator, const Arguments& arguments) {
  const std::string& separator = TextArgument(arguments, 0);
  std::string text;
  bool first = true;
  for (const Value& item : elaborator.Items(arguments[1], arguments.Place(1))) {
    if (!item.Is(ValueKind::kString)) {
      Fail("type", arguments.Place(1), "strings are joined, one of these is " + Describe(item));
    }
    text += (first ? "" : separator) + item.text;
    first = false;
    if (text.size() > kLongestString) break;  // rejected below
  }
  return Bounded(std::move(text), arguments.position);
}

// Implements "{}_{1:.2f}".format(...): values by their order or number.
Value FormatTemplate(Elaborator&, const Arguments& arguments) {
  const std::string& text = TextArgument(arguments, 0);
  const std::vector<Value>& values = *arguments[1].items;
  std::string result;
  std::size_t next = 0;
  for (std::size_t at = 0; at < text.size() && result.size() <= kLongestString; ++at) {
    const char c = text[at];
    if ((c == '{' || c == '}') && at + 1 < text.size() && text[at + 1] == c) {
      result += text[++at];
      continue;
    }
    if (c != '{') {
      result += c;
      continue;
    }
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) {
      Fail("bad-string", arguments.Place(0), "a '{' of this string is not closed");
    }
    const std::string inside = text.substr(at + 1, end - at - 1);
    const std::size_t colon = std::min(inside.find(':'), inside.size());
    const std::string name = inside.substr(0, colon);
    const bool number =
        name.size() < 4 && name.find_first_not_of("0123456789") == std::string::npos;
    const std::size_t which = name.empty() ? next++ : number ? std::stoul(name) : values.size();
    if (which >= values.size()) {
      Fail("bad-string", arguments.Place(0),
           "'{" + inside.substr(0, 40) + "}' stands for none of the " +
               std::to_string(values.size()) + " values; an f-string may name them");
    }
    const std::string format = colon < inside.size() ? inside.substr(colon + 1) : "";
    result += FormatValue(values[which], format, '\0', arguments.position);
    at = end;
  }
  return Bounded(std::move(result), arguments.position);
}

constexpr ScalarOperation kNoStringOperation = ScalarOperation::kConstant;

constexpr LibraryFunction kStringFunctions[] = {
    {"str repr", "x", Text},
    {"String.upper", "text", Recased, kNoStringOperation, kUpper},
    {"String.lower", "text", Recased, kNoStringOperation, kLower},
    {"String.capitalize", "text", Recased, kNoStringOperation, kCapital},
    {"String.startswith", "text prefix", Affix, kNoStringOperation, 0},
    {"String.endswith", "text suffix", Affix, kNoStringOperation, 1},
    {"String.replace", "text old new", Replace},
    {"String.strip", "text chars=None", Strip, kNoStringOperation, 0},
    {"String.lstrip", "text chars=None", Strip, kNoStringOperation, 1},
    {"String.rstrip", "text chars=None", Strip, kNoStringOperation, 2},
    {"String.split", "text separator", SplitText},
    {"String.join", "separator texts", JoinTexts},
    {"String.format", "text *values", FormatTemplate},
};

}  // namespace

LibraryPart StringFunctions() {
  return {kStringFunctions, std::size(kStringFunctions)};
}

}  // namespace simwright::reward
