#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "reward/fault.h"

namespace simwright::reward {

enum class Operator {
  kNone,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kFloorDivide,
  kRemainder,
  kPower,
  kMatrixMultiply,
  kAnd,  // & on flags and integers
  kOr,
  kExclusiveOr,
  kInvert,
  kNegate,
  kPlus,
  kNot,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kIn,
  kNotIn,
  kIs,
  kIsNot,
  kBooleanAnd,
  kBooleanOr,
};

enum class ExpressionKind {
  kNone,
  kTrue,
  kFalse,
  kEllipsis,
  kInteger,
  kFloat,
  kString,
  kFormatString,  // children: the parts to join
  kFormatted,     // children[0] as text; text: the format after ':'; integer: the letter after '!'
  kName,          // text
  kTuple,
  kList,
  kDict,         // children: key, value, key, value ...; without a key: a ** entry
  kStarred,      // *children[0], in a target or a list
  kUnary,        // operation, children[0]
  kBinary,       // operation, children[0..1]
  kCompare,      // children[0] operations[0] children[1] operations[1] ...
  kBoolean,      // operation, children
  kConditional,  // children: condition, then, otherwise
  kCall,         // children[0]: callee; then arguments, named by keywords ("", "*", "**": none)
  kAttribute,    // children[0].text
  kSubscript,    // children[0][children[1]]
  kSlice,        // children: start, stop, step; each may be null
  kListComprehension,  // children: element, target, iterable, condition or null
  kDictComprehension,  // children: key, target, iterable, condition or null, value
};

struct Expression;
using ExpressionPtr = std::unique_ptr<Expression>;

struct Expression {
  ExpressionKind kind = ExpressionKind::kNone;
  Position position;  // operation: its sign; attribute: its name; call: its callee
  int depth = 1;      // depth of the tree below
  Operator operation = Operator::kNone;
  std::string text;
  std::int64_t integer = 0;
  double number = 0.0;
  std::vector<ExpressionPtr> children;
  std::vector<Operator> operations;
  std::vector<std::string> keywords;
};

enum class StatementKind {
  kExpression,  // value
  kAssign,      // targets = value
  kAugmented,   // targets[0] operation= value
  kReturn,      // value or null
  kIf,          // targets: conditions; blocks: one per condition, then one for else
  kFor,         // targets[0] in value: blocks[0]
  kBlock,       // blocks[0], the body of a harmless `with`
  kFunction,    // function, defined inside another function
  kDelete,      // targets
  kImport,      // imports
  kPass,
  kBreak,
  kContinue,
};

struct Function;
struct Statement;
using Block = std::vector<std::unique_ptr<Statement>>;

struct Import {
  std::string module;  // "torch.nn"
  std::string name;    // name after `from`; "*" for all, empty for a plain import
  std::string alias;   // the name that is bound
  Position position;
};

struct Statement {
  StatementKind kind = StatementKind::kPass;
  Position position;
  Operator operation = Operator::kNone;
  std::vector<ExpressionPtr> targets;
  ExpressionPtr value;
  std::vector<Block> blocks;
  std::vector<Import> imports;
  std::shared_ptr<const Function> function;
};

struct Parameter {
  std::string name;
  Position position;
  ExpressionPtr annotation;  // null: none
  ExpressionPtr initial;     // null: none
};

struct Function {
  std::string name;
  Position position;
  std::vector<Parameter> parameters;
  Block body;
  std::set<std::string> locals;  // names that the body binds
};

struct Module {
  std::vector<std::unique_ptr<Function>> functions;
  Block statements;  // imports and constants
};

}  // namespace simwright::reward
