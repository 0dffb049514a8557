#include <algorithm>

#include "reward/frontend/foreign_names.h"
#include "reward/frontend/spelling.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

std::vector<Value> IndexParts(const Value& index) {
  return index.Is(ValueKind::kTuple) ? *index.items : std::vector<Value>{index};
}

bool IsWhole(const Value& slice) {
  const std::vector<Value>& parts = *slice.items;
  const bool from_start =
      parts[0].Is(ValueKind::kNone) || (parts[0].Is(ValueKind::kInteger) && parts[0].integer == 0);
  const bool to_end = parts[1].Is(ValueKind::kNone) || parts[1].Is(ValueKind::kBatchSize);
  const bool each =
      parts[2].Is(ValueKind::kNone) || (parts[2].Is(ValueKind::kInteger) && parts[2].integer == 1);
  return from_start && to_end && each;
}

// Returns the index of a key; the number of keys if it is absent.
std::size_t PlaceOfKey(const std::vector<Value>& keys, const Value& key) {
  const auto same = [&](const Value& other) {
    return other.kind == key.kind && other.text == key.text && other.integer == key.integer;
  };
  return static_cast<std::size_t>(std::find_if(keys.begin(), keys.end(), same) - keys.begin());
}

struct Bounds {
  std::int64_t start, stop, step;
};

// Returns a slice's bounds for `size` elements, clipped as in Python.
Bounds Clip(const Value& slice, std::int64_t size, Position position) {
  std::int64_t given[3] = {0, size, 1};
  for (int i = 0; i < 3; ++i) {
    const Value& part = (*slice.items)[i];
    if (part.Is(ValueKind::kNone)) continue;
    if (!part.Is(ValueKind::kInteger)) {
      Fail("index", position, "a slice wants whole numbers, this is " + Describe(part));
    }
    given[i] = part.integer;
  }
  if (given[2] < 1) {
    Fail("index", position,
         "a slice of a tensor goes forward, as torch wants it; use .flip(dim) to turn the order "
         "round");
  }
  for (int i = 0; i < 2; ++i) {
    if (given[i] < 0) given[i] = std::max<std::int64_t>(0, given[i] + size);
    given[i] = std::min(given[i], size);
  }
  return {given[0], std::max(given[0], given[1]), std::min<std::int64_t>(given[2], size + 1)};
}

// Returns the elements that a slice of a list selects, in reverse order if its step is negative.
std::vector<std::int64_t> Indices(const Value& slice, std::int64_t size, Position position) {
  const Value& step = (*slice.items)[2];
  std::vector<std::int64_t> indices;
  if (!step.Is(ValueKind::kInteger) || step.integer >= 0) {
    const Bounds bounds = Clip(slice, size, position);
    for (std::int64_t i = bounds.start; i < bounds.stop; i += bounds.step) indices.push_back(i);
    return indices;
  }
  std::int64_t ends[2] = {size - 1, -1};
  for (int i = 0; i < 2; ++i) {
    const Value& part = (*slice.items)[i];
    if (part.Is(ValueKind::kNone)) continue;
    if (!part.Is(ValueKind::kInteger)) {
      Fail("index", position, "a slice wants whole numbers, this is " + Describe(part));
    }
    const std::int64_t at = part.integer < 0 ? part.integer + size : part.integer;
    ends[i] = std::clamp<std::int64_t>(at, -1, size - 1);
  }
  const std::int64_t back = std::max(step.integer, -size - 1);
  for (std::int64_t i = ends[0]; i > ends[1]; i += back) indices.push_back(i);
  return indices;
}

}  // namespace

bool Elaborator::IsMask(const Value& index) const {
  return index.Is(ValueKind::kTensor) && index.tensor->type == DataType::kBool;
}

Tensor Elaborator::SliceTensor(const Tensor& tensor, int dimension, const Value& slice,
                               Position position) {
  if (IsWhole(slice)) return tensor;
  if (RunsOverEnvironments(tensor.shape[dimension])) {
    Fail("index", position,
         "a part of the environments cannot be taken: every environment gets its own reward");
  }
  const Bounds bounds = Clip(slice, tensor.shape[dimension], position);
  return math_.Slice(tensor, dimension, bounds.start, bounds.stop, bounds.step);
}

// Applies one part of an index to dimension *dimension and advances it. For x[mask], later
// reductions over the environments skip those that were not selected.
Tensor Elaborator::SelectByMask(const Tensor& tensor, const Tensor& mask, int dimension,
                                Position position) {
  if (mask.shape != Shape{kBatch} || tensor.shape[dimension] != kBatch) {
    Fail("index", position,
         "a mask " + ShapeText(mask.shape) + " does not pick environments of a tensor " +
             ShapeText(tensor.shape) +
             ", and how many single numbers it picks is not known before; use torch.where(mask, "
             "a, b)");
  }
  Tensor picked = math_.Copy(tensor, position);
  picked.shape[dimension] = SelectedBy(math_.At(mask, 0));
  return picked;
}

Tensor Elaborator::ApplyIndex(const Tensor& tensor, const Value& index, int* dimension,
                              Position position) {
  if (index.Is(ValueKind::kNone)) return math_.Unsqueeze(tensor, (*dimension)++);
  if (*dimension >= static_cast<int>(tensor.shape.size())) {
    Fail("index", position,
         "there are more indices than dimensions: the tensor is " + ShapeText(tensor.shape));
  }
  if (index.Is(ValueKind::kInteger)) return math_.Take(tensor, *dimension, index.integer, position);
  if (index.Is(ValueKind::kSlice)) return SliceTensor(tensor, (*dimension)++, index, position);
  if (index.Is(ValueKind::kList)) {
    std::vector<Tensor> parts;
    for (const Value& item : Items(index, position)) {
      if (!item.Is(ValueKind::kInteger)) {
        Fail("index", position, "a list of indices wants whole numbers, this is " + Describe(item));
      }
      parts.push_back(
          math_.Unsqueeze(math_.Take(tensor, *dimension, item.integer, position), *dimension));
    }
    if (parts.empty()) Fail("index", position, "the list of indices is empty");
    return math_.Concatenate(parts, (*dimension)++, position);
  }
  float known = 0.0f;
  if (index.Is(ValueKind::kTensor) && index.tensor->type == DataType::kInteger &&
      index.tensor->shape.empty() && graph_.IsConstant(math_.At(*index.tensor, 0), &known)) {
    return math_.Take(tensor, *dimension, static_cast<std::int64_t>(known), position);
  }
  if (IsMask(index)) return SelectByMask(tensor, *index.tensor, (*dimension)++, position);
  Fail("index", position,
       "an index is a whole number, a slice, None or '...'; this is " + Describe(index));
}

Tensor Elaborator::SubscriptTensor(const Tensor& tensor, const Value& index, Position position) {
  const std::vector<Value> parts = IndexParts(index);
  int taken = 0;  // dimensions that the parts consume
  for (const Value& part : parts) {
    if (!part.Is(ValueKind::kNone) && !part.Is(ValueKind::kEllipsis)) ++taken;
  }
  Tensor view = tensor;
  int dimension = 0;
  bool ellipsis = false;
  for (const Value& part : parts) {
    if (!part.Is(ValueKind::kEllipsis)) {
      view = ApplyIndex(view, part, &dimension, position);
      continue;
    }
    if (ellipsis) Fail("index", position, "'...' may stand once in an index");
    ellipsis = true;
    dimension += std::max(0, static_cast<int>(tensor.shape.size()) - taken);
  }
  return view;
}

Value Elaborator::SubscriptItems(const Value& base, const std::vector<Value>& items,
                                 const Value& index, Position position) {
  const auto size = static_cast<std::int64_t>(items.size());
  if (index.Is(ValueKind::kSlice)) {
    std::vector<Value> taken;
    for (const std::int64_t i : Indices(index, size, position)) taken.push_back(items[i]);
    return base.Is(ValueKind::kList) ? NewList(std::move(taken)) : TupleValue(std::move(taken));
  }
  if (index.Is(ValueKind::kString) && base.field_names != nullptr) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if ((*base.field_names)[i] == index.text) return items[i];
    }
    Fail("bad-key", position,
         "there is no '" + index.text + "' in this" + Suggestion(index.text, *base.field_names));
  }
  if (!index.Is(ValueKind::kInteger)) {
    Fail("index", position, "a whole number is wanted as index, this is " + Describe(index));
  }
  if (index.integer < -size || index.integer >= size) {
    Fail("index", position,
         "there is no element " + std::to_string(index.integer) + " among " + std::to_string(size));
  }
  return items[index.integer < 0 ? index.integer + size : index.integer];
}

Value Elaborator::SubscriptDict(const Value& base, const Value& index, Position position) {
  const Object& dict = heap_[base.object];
  std::vector<std::string> known;
  for (std::size_t i = 0; i < dict.keys->size(); ++i) {
    const Value& key = (*dict.keys)[i];
    if (key.kind == index.kind && key.text == index.text && key.integer == index.integer) {
      return (*dict.items)[i];
    }
    if (key.Is(ValueKind::kString)) known.push_back(key.text);
  }
  Fail("bad-key", position,
       "the dictionary has no key " + (index.Is(ValueKind::kString)
                                           ? "'" + index.text + "'" + Suggestion(index.text, known)
                                           : "like this: " + Describe(index)));
}

Value Elaborator::Subscript(const Value& base, const Value& index, Position position) {
  Value value;
  switch (base.kind) {
    case ValueKind::kTensor:
      return TensorValue(SubscriptTensor(*base.tensor, index, position));
    case ValueKind::kTuple:
      value = SubscriptItems(base, *base.items, index, position);
      break;
    case ValueKind::kList:
      value = SubscriptItems(base, *heap_[base.object].items, index, position);
      break;
    case ValueKind::kDict:
      value = SubscriptDict(base, index, position);
      break;
    case ValueKind::kOpaque:
      if (base.text.starts_with(kForeignPrefix) && index.Is(ValueKind::kString)) {
        return PlainValue(ValueKind::kOpaque, base.text + "[\"" + index.text + "\"]");
      }
      return base;  // Dict[str, Tensor]
    case ValueKind::kUndefined:
      Fail(base.text.empty() ? "" : "undefined", position, base.text);
    default:
      Fail("index", position, Describe(base) + " has no elements");
  }
  if (value.Is(ValueKind::kUndefined)) {
    Fail(value.text.empty() ? "" : "undefined", position, value.text);
  }
  return value;
}

// Returns the mask as flags for every number of the tensor.
Tensor Elaborator::MaskFor(const Tensor& tensor, const Value& index, Position position) {
  Tensor mask = *index.tensor;
  const bool fits = mask.shape.size() <= tensor.shape.size() &&
                    std::equal(mask.shape.begin(), mask.shape.end(), tensor.shape.begin());
  if (!fits) {
    Fail("shape", position,
         "a mask " + ShapeText(mask.shape) + " does not fit a tensor " + ShapeText(tensor.shape));
  }
  while (mask.shape.size() < tensor.shape.size()) {
    mask = math_.Unsqueeze(mask, static_cast<int>(mask.shape.size()));
  }
  return math_.Expand(mask, tensor.shape, position);
}

void Elaborator::AssignSubscript(const Expression& target, const Value& value) {
  const Value base = Evaluate(*target.children[0]);
  const Value index = Evaluate(*target.children[1]);
  if (base.Is(ValueKind::kTensor)) {
    AssignInTensor(*base.tensor, index, value, target.position);
    return;
  }
  if (!base.Is(ValueKind::kList) && !base.Is(ValueKind::kDict)) {
    if (base.Is(ValueKind::kUndefined)) math_.FromValue(base, target.position);
    Fail("bad-target", target.position, Describe(base) + " cannot be changed");
  }
  // This ensures that no object contains itself.
  if (HoldsContainer(value)) {
    Fail("type", target.position, "a list or dictionary inside another cannot be set here");
  }
  AssignInContainer(base, index, value, target.position);
}

void Elaborator::AssignInTensor(const Tensor& tensor, const Value& index, const Value& value,
                                Position position) {
  Value key = index;
  Tensor view = tensor;
  // A mask over the environments with an index of the other dimensions: t[mask, 2].
  if (index.Is(ValueKind::kTuple) && !index.items->empty() && IsMask((*index.items)[0]) &&
      (*index.items)[0].tensor->shape.size() == 1) {
    std::vector<Value> parts = *index.items;
    key = parts[0];
    parts[0] = TupleValue({Value{}, Value{}, Value{}});
    parts[0].kind = ValueKind::kSlice;
    view = SubscriptTensor(view, TupleValue(std::move(parts)), position);
  } else if (!IsMask(index)) {
    view = SubscriptTensor(view, index, position);
    // The row of one environment is a copy here: a write to it would be lost.
    if (view.storage != tensor.storage) {
      Fail("index", position,
           "this sets a copy, since the index names single elements or one environment; set each "
           "column, t[:, i] = ...");
    }
  }
  Tensor fresh = math_.FromValue(value, position);
  if (fresh.type > view.type && view.type != DataType::kFloat) {
    fresh = math_.Cast(fresh, view.type, position);
  }
  if (IsMask(key)) {
    fresh = ExpandToEnvironments(fresh, *key.tensor, position);
    fresh = math_.Select(MaskFor(view, key, position), fresh, view, position);
  }
  // A leading 1 of the assigned value may be dropped, as in torch.
  while (fresh.shape.size() > view.shape.size() && fresh.shape[0] == 1) {
    fresh = math_.Squeeze(fresh, 0);
  }
  math_.Write(view, math_.Nodes(math_.Expand(fresh, view.shape, position)));
}

// Returns a value for assignment through a mask as one with a row for each environment: a number, a
// value that all environments share, or a value selected by the same mask.
Tensor Elaborator::ExpandToEnvironments(const Tensor& value, const Tensor& mask,
                                        Position position) {
  Tensor all = value;
  const bool rows = mask.shape == Shape{kBatch} && !all.shape.empty();
  if (rows && all.shape[0] == SelectedBy(math_.At(mask, 0))) {
    all.shape[0] = kBatch;
    return all;
  }
  if (HasSelectedDimension(all.shape) || BatchDimension(all.shape) >= 0 ||
      (!rows && !all.shape.empty())) {
    Fail("index", position,
         "a mask takes a number here or what the same mask picks, a[mask] = b[mask], this is " +
             Describe(TensorValue(value)) + "; use torch.where(mask, a, b)");
  }
  return all;
}

void Elaborator::AssignInContainer(const Value& base, const Value& index, const Value& value,
                                   Position position) {
  if (base.Is(ValueKind::kDict)) {
    SetKey(base, index, value, position);
    return;
  }
  Object fresh = heap_[base.object];
  std::vector<Value> items = *fresh.items;
  SubscriptItems(base, items, index, position);  // checks the index
  if (!index.Is(ValueKind::kInteger)) Fail("index", position, "a list is changed one by one");
  const auto size = static_cast<std::int64_t>(items.size());
  items[index.integer < 0 ? index.integer + size : index.integer] = value;
  fresh.items = std::make_shared<const std::vector<Value>>(std::move(items));
  heap_.Set(base.object, std::move(fresh));
}

void Elaborator::SetKey(const Value& dict, const Value& key, const Value& value,
                        Position position) {
  if (!key.Is(ValueKind::kString) && !key.Is(ValueKind::kInteger)) {
    Fail("bad-key", position, "a key is a string or a whole number, this is " + Describe(key));
  }
  std::vector<Value> keys = *heap_[dict.object].keys, items = *heap_[dict.object].items;
  const std::size_t at = PlaceOfKey(keys, key);
  if (at == keys.size()) {
    keys.push_back(key);
    items.push_back(value);
  }
  items[at] = value;
  Object fresh;
  fresh.keys = std::make_shared<const std::vector<Value>>(std::move(keys));
  fresh.items = std::make_shared<const std::vector<Value>>(std::move(items));
  heap_.Set(dict.object, std::move(fresh));
}

void Elaborator::Update(const Value& dict, const Value& other, Position position) {
  if (!other.Is(ValueKind::kDict)) {
    Fail("type", position, "a dictionary is wanted here, this is " + Describe(other));
  }
  const Object contents = heap_[other.object];
  for (std::size_t i = 0; i < contents.keys->size(); ++i) {
    Step(position);
    SetKey(dict, (*contents.keys)[i], (*contents.items)[i], position);
  }
}

Value Elaborator::RemoveKey(const Value& dict, const Value& key, Position position) {
  const Value removed = Subscript(dict, key, position);  // throws if the key is missing
  std::vector<Value> keys = *heap_[dict.object].keys, items = *heap_[dict.object].items;
  const auto at = static_cast<std::ptrdiff_t>(PlaceOfKey(keys, key));
  keys.erase(keys.begin() + at);
  items.erase(items.begin() + at);
  Object fresh;
  fresh.keys = std::make_shared<const std::vector<Value>>(std::move(keys));
  fresh.items = std::make_shared<const std::vector<Value>>(std::move(items));
  heap_.Set(dict.object, std::move(fresh));
  return removed;
}

// Implements t[mask] += x and t[mask, 2] += x.
bool Elaborator::AugmentMasked(const Statement& statement) {
  const Expression& target = *statement.targets[0];
  const Position position = statement.position;
  const Value base = Evaluate(*target.children[0]);
  if (!base.Is(ValueKind::kTensor)) return false;
  const Value index = Evaluate(*target.children[1]);
  const bool first = index.Is(ValueKind::kTuple) && !index.items->empty() &&
                     IsMask((*index.items)[0]) && (*index.items)[0].tensor->shape.size() == 1;
  if (!IsMask(index) && !first) return false;
  const Value operand = Evaluate(*statement.value);
  const bool rows = first || index.tensor->shape.size() == 1;
  const Value old = rows ? Subscript(base, index, target.position) : base;
  const Value fresh = Binary(statement.operation, old, operand, position);
  CheckFits(*old.tensor, *fresh.tensor, position);
  if (rows) {
    AssignInTensor(*base.tensor, index, fresh, target.position);
    return true;
  }
  const Tensor mask = MaskFor(*base.tensor, index, target.position);
  if (!math_.FromValue(operand, position).shape.empty()) {
    Fail("index", target.position,
         "only a number can be put where a mask picks single numbers; use torch.where(mask, a, b)");
  }
  math_.Write(*base.tensor, math_.Nodes(math_.Select(mask, *fresh.tensor, *base.tensor, position)));
  return true;
}

}  // namespace simwright::reward
