#include <algorithm>
#include <map>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

struct Einsum {
  std::vector<std::string> inputs;
  std::string output;
};

Einsum ParseEinsum(const std::string& text, Position position) {
  Einsum einsum;
  std::string current;
  bool arrow = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ') continue;
    if (c == ',' && !arrow) {
      einsum.inputs.push_back(current);
      current.clear();
    } else if (c == '-' && i + 1 < text.size() && text[i + 1] == '>' && !arrow) {
      arrow = true;
      ++i;
      einsum.inputs.push_back(current);
      current.clear();
    } else if (std::isalpha(static_cast<unsigned char>(c))) {
      current += c;
    } else {
      Fail("einsum", position,
           std::string("'") + c + "' has no place in an einsum such as 'bi,bi->b'");
    }
  }
  if (arrow) {
    einsum.output = current;
    return einsum;
  }
  einsum.inputs.push_back(current);
  std::map<char, int> seen;  // without an arrow: the letters that occur once, sorted
  for (const std::string& input : einsum.inputs) {
    for (const char c : input) ++seen[c];
  }
  for (const auto& [letter, count] : seen) {
    if (count == 1) einsum.output += letter;
  }
  return einsum;
}

// Returns the tensor with one dimension per letter, in the order of `letters`; a letter that it
// lacks has size 1.
Tensor Aligned(TensorMath& math, const Tensor& tensor, const std::string& own,
               const std::string& letters) {
  std::vector<int> order;
  for (const char c : letters) {
    const std::size_t at = own.find(c);
    if (at != std::string::npos) order.push_back(static_cast<int>(at));
  }
  Tensor aligned = math.Permute(tensor, order);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (own.find(letters[i]) == std::string::npos)
      aligned = math.Unsqueeze(aligned, static_cast<int>(i));
  }
  return aligned;
}

Value EinsumOf(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  if (!arguments[0].Is(ValueKind::kString)) {
    Fail("einsum", arguments.Place(0), "einsum begins with its formula, such as 'bi,bi->b'");
  }
  const Einsum einsum = ParseEinsum(arguments[0].text, arguments.Place(0));
  std::vector<Value> operands = *arguments[1].items;
  if (operands.size() != einsum.inputs.size()) {
    Fail("einsum", arguments.Place(0),
         "the formula names " + std::to_string(einsum.inputs.size()) + " tensors, " +
             std::to_string(operands.size()) + " are given");
  }
  std::string letters = einsum.output;
  for (const std::string& input : einsum.inputs) {
    for (const char c : input) {
      if (letters.find(c) == std::string::npos) letters += c;
    }
  }
  Tensor product;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Tensor tensor = math.FromValue(operands[i], arguments.Place(1));
    const std::string& own = einsum.inputs[i];
    std::string sorted = own;
    std::sort(sorted.begin(), sorted.end());
    if (own.size() != tensor.shape.size() ||
        std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      Fail("einsum", arguments.Place(0),
           "'" + own + "' does not name the dimensions of " + ShapeText(tensor.shape) +
               " one by one");
    }
    const Tensor aligned = Aligned(math, tensor, own, letters);
    product = i == 0 ? aligned
                     : math.Map(kMultiply, product, aligned, Promote(product.type, aligned.type),
                                position);
  }
  for (std::size_t i = 0; i < einsum.output.size(); ++i) {
    bool known = einsum.output.find(einsum.output[i]) == i;
    known = known && std::any_of(einsum.inputs.begin(), einsum.inputs.end(), [&](const auto& own) {
              return own.find(einsum.output[i]) != std::string::npos;
            });
    if (!known) {
      Fail("einsum", arguments.Place(0),
           std::string("'") + einsum.output[i] + "' of the result stands in no tensor, or twice");
    }
  }
  std::vector<int> summed;
  for (std::size_t i = einsum.output.size(); i < letters.size(); ++i) {
    summed.push_back(static_cast<int>(i));
  }
  return TensorValue(math.Reduce(Reduction::kSum, product, summed, false, position));
}

// Returns the sum of products along a dimension.
Tensor Contract(TensorMath& math, const Tensor& a, const Tensor& b, int dimension, bool keep,
                Position position) {
  const Tensor product = math.Map(kMultiply, a, b, Promote(a.type, b.type), position);
  return math.Reduce(Reduction::kSum, product,
                     {math.Dimension(dimension, product.shape.size(), position)}, keep, position);
}

// Implements torch's matmul; dot (variant 1) takes vectors, bmm and mm are checked by their shapes
// alone.
Value Matmul(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  Tensor a = TensorArgument(elaborator, arguments, 0);
  Tensor b = TensorArgument(elaborator, arguments, 1);
  const bool numpy = arguments.called.starts_with("np.");
  if (arguments.function->variant == 1 && numpy && (a.shape.empty() || b.shape.empty())) {
    return elaborator.Binary(Operator::kMultiply, arguments[0], arguments[1], position);
  }
  const bool vectors = a.shape.size() == 1 && b.shape.size() == 1;
  if (a.shape.empty() || b.shape.empty() ||
      (arguments.function->variant == 1 && !numpy && !vectors)) {
    Fail("shape", position,
         "'" + arguments.called + "' does not multiply " + ShapeText(a.shape) + " and " +
             ShapeText(b.shape) + "; for a product an environment use (a * b).sum(dim=-1)");
  }
  if (vectors) return TensorValue(Contract(math, a, b, 0, false, position));
  const bool row = a.shape.size() == 1, column = b.shape.size() == 1;
  if (row) a = math.Unsqueeze(a, 0);
  if (column) b = math.Unsqueeze(b, 1);
  if (a.shape.back() != b.shape[b.shape.size() - 2]) {
    Fail("shape", position,
         "'" + arguments.called + "' does not multiply " + ShapeText(a.shape) + " and " +
             ShapeText(b.shape) + ": the inner sizes differ");
  }
  // [.., i, k, 1] times [.., 1, k, j], summed over k.
  a = math.Unsqueeze(a, static_cast<int>(a.shape.size()));
  b = math.Unsqueeze(b, static_cast<int>(b.shape.size()) - 2);
  Tensor product = Contract(math, a, b, -2, false, position);
  if (column) product = math.Squeeze(product, static_cast<int>(product.shape.size()) - 1);
  if (row) {
    product = math.Squeeze(product, static_cast<int>(product.shape.size()) - (column ? 1 : 2));
  }
  return TensorValue(std::move(product));
}

Value Cross(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor a = TensorArgument(elaborator, arguments, 0);
  const Tensor b = TensorArgument(elaborator, arguments, 1);
  const Shape shape = math.Broadcast(a.shape, b.shape, position);
  const std::int64_t wanted =
      arguments[2].Is(ValueKind::kNone) ? -1 : IntegerArgument(elaborator, arguments, 2);
  const int dimension = math.Dimension(wanted, shape.size(), position);
  if (shape[dimension] != 3) {
    Fail("shape", position, "a cross product is of vectors [.., 3], these are " + ShapeText(shape));
  }
  const Tensor x = math.Expand(a, shape, position), y = math.Expand(b, shape, position);
  std::vector<Tensor> parts;
  for (int i = 0; i < 3; ++i) {
    const auto times = [&](int p, int q) {
      return math.Map(kMultiply, math.Take(x, dimension, p, position),
                      math.Take(y, dimension, q, position), Promote(a.type, b.type), position);
    };
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Tensor part =
        math.Map(kSubtract, times(j, k), times(k, j), Promote(a.type, b.type), position);
    parts.push_back(math.Unsqueeze(part, dimension));
  }
  return TensorValue(math.Concatenate(parts, dimension, position));
}

Tensor VectorLength(TensorMath& math, const Tensor& tensor, int dimension, bool keep,
                    Position position) {
  return math.Map(kSquareRoot, Contract(math, tensor, tensor, dimension, keep, position),
                  DataType::kFloat, position);
}

// Normalizes along a dimension, with the minimum length `eps`; Isaac Gym's `normalize` (variant 1)
// along the last one.
Value Normalize(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor tensor = FloatArgument(elaborator, arguments, 0);
  const bool plain = arguments.function->variant == 1;
  const std::int64_t along = plain ? -1 : IntegerArgument(elaborator, arguments, 2);
  const double eps = NumberArgument(elaborator, arguments, plain ? 1 : 3);
  if (!plain && NumberArgument(elaborator, arguments, 1) != 2.0) {
    Fail("arguments", arguments.Place(1), "normalize is offered for p=2 alone");
  }
  const int dimension = math.Dimension(along, tensor.shape.size(), position);
  const Tensor least = math.Scalar(DataType::kFloat, math.graph().Constant(eps));
  const Tensor length = math.Map(kMaximum, VectorLength(math, tensor, dimension, true, position),
                                 least, DataType::kFloat, position);
  return TensorValue(math.Map(kDivide, tensor, length, DataType::kFloat, position));
}

// Returns a . b / max(|a| |b|, eps) along a dimension.
Value CosineSimilarity(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor a = FloatArgument(elaborator, arguments, 0);
  const Tensor b = FloatArgument(elaborator, arguments, 1);
  const auto along = static_cast<int>(IntegerArgument(elaborator, arguments, 2));
  const Tensor eps = math.Scalar(DataType::kFloat,
                                 math.graph().Constant(NumberArgument(elaborator, arguments, 3)));
  const auto length = [&](const Tensor& tensor) {
    return math.Map(kMaximum, VectorLength(math, tensor, along, false, position), eps,
                    DataType::kFloat, position);
  };
  const Tensor lengths = math.Map(kMultiply, length(a), length(b), DataType::kFloat, position);
  return TensorValue(math.Map(kDivide, Contract(math, a, b, along, false, position), lengths,
                              DataType::kFloat, position));
}

// Returns the distance between every row of a [.., P, k] and of b [.., R, k].
Value Cdist(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  Tensor a = FloatArgument(elaborator, arguments, 0), b = FloatArgument(elaborator, arguments, 1);
  if (a.shape.size() < 2 || b.shape.size() < 2) {
    Fail("shape", position, "cdist wants points in rows, [.., P, k] and [.., R, k]");
  }
  if (a.shape.back() != b.shape.back()) {
    Fail("shape", position,
         "the points have different sizes, " + ShapeText(a.shape) + " and " + ShapeText(b.shape));
  }
  a = math.Unsqueeze(a, static_cast<int>(a.shape.size()) - 1);
  b = math.Unsqueeze(b, static_cast<int>(b.shape.size()) - 2);
  const Tensor gap = math.Map(kSubtract, a, b, DataType::kFloat, position);
  return TensorValue(VectorLength(math, gap, -1, false, position));
}

// Returns |a - b + eps| along the last dimension.
Value PairwiseDistance(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor gap = math.Map(kSubtract, FloatArgument(elaborator, arguments, 0),
                              FloatArgument(elaborator, arguments, 1), DataType::kFloat, position);
  const Tensor eps = math.Scalar(DataType::kFloat, math.graph().Constant(1e-6));
  return TensorValue(VectorLength(math, math.Map(kAdd, gap, eps, DataType::kFloat, position), -1,
                                  false, position));
}

// Returns a_i b_j of two vectors.
Value Outer(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor a = TensorArgument(elaborator, arguments, 0);
  const Tensor b = TensorArgument(elaborator, arguments, 1);
  if (a.shape.size() != 1 || b.shape.size() != 1) {
    Fail("shape", arguments.position,
         "an outer product is of two vectors, these are " + ShapeText(a.shape) + " and " +
             ShapeText(b.shape));
  }
  return TensorValue(math.Map(kMultiply, math.Unsqueeze(a, 1), math.Unsqueeze(b, 0),
                              Promote(a.type, b.type), arguments.position));
}

constexpr LibraryFunction kProductFunctions[] = {
    {"torch.einsum np.einsum", "equation *operands", EinsumOf},
    {"torch.matmul torch.bmm torch.mm torch.mv np.matmul Tensor.matmul Tensor.mm Tensor.bmm",
     "input other", Matmul},
    {"torch.dot Tensor.dot np.dot torch.inner", "input other", Matmul, kConstant, 1},
    {"torch.cross torch.linalg.cross np.cross Tensor.cross", "input other dim=None", Cross},
    {"torch.nn.functional.normalize", "input p=2 dim=1 eps=1e-12", Normalize},
    {"normalize quat_unit", "x eps=1e-9", Normalize, kConstant, 1},
    {"torch.cosine_similarity torch.nn.functional.cosine_similarity", "x1 x2 dim=1 eps=1e-8",
     CosineSimilarity},
    {"torch.cdist cdist", "x1 x2", Cdist},
    {"torch.nn.functional.pairwise_distance torch.pairwise_distance", "x1 x2", PairwiseDistance},
    {"torch.outer torch.ger np.outer", "input vec2", Outer},
};

}  // namespace

LibraryPart ProductFunctions() {
  return {kProductFunctions, std::size(kProductFunctions)};
}

}  // namespace simwright::reward
