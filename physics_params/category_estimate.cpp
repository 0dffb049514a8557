#include "physics_params/category_estimate.h"

#include <optional>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

constexpr int kAttempts = 2;  // a third attempt would not help

bool SaysSomething(const ObjectAnswer& object) {
  return object.mass || object.length || object.width || object.height;
}

// Returns the requested object from the model's answer; unset if there is none.
std::optional<ObjectAnswer> Usable(const PhysicsAnswer& answer, const std::string& name,
                                   bool known) {
  const ObjectAnswer* object = FindObject(answer, name);
  if (object == nullptr || !SaysSomething(*object)) return std::nullopt;
  const bool whole = object->mass && object->length && object->width && object->height;
  return known || whole ? std::optional<ObjectAnswer>(*object) : std::nullopt;
}

}  // namespace

llm::ChatRequest PhysicsQuestion(std::string_view name, const KnowledgeBase& base) {
  const std::string object_name = NormaliseName(name);
  std::string materials;
  for (const Material& material : base.materials()) {
    materials += (materials.empty() ? "" : ", ") + material.name;
  }
  llm::ChatRequest request;
  request.task = "physics of " + object_name;
  request.temperature = 0.0;
  request.messages.push_back(
      {llm::Role::kSystem,
       "You know the sizes and masses of everyday things. You answer with the lines asked for and "
       "nothing else.",
       {}});
  request.messages.push_back(
      {llm::Role::kUser,
       "How large and how heavy is the usual thing called '" + object_name +
           "', as it stands in a home or shop? Give ranges that hold most of them. Length is its "
           "longer side on the ground, width the shorter one, height goes up from the ground. "
           "Answer in four lines:\n"
           "object: " +
           object_name +
           "\n"
           "mass in grams: LEAST-MOST\n"
           "length, width, height in centimeters: LEAST-MOST, LEAST-MOST, LEAST-MOST\n"
           "material: one to three, the likeliest first, out of: " +
           materials,
       {}});
  return request;
}

EstimatedCategory EstimateCategory(std::string_view name, const KnowledgeBase& base,
                                   const WordNet* wordnet, llm::ChatModel* model,
                                   core::Progress* progress) {
  const std::string object_name = NormaliseName(name);
  const Resolution known = ResolveCategory(object_name, base, wordnet);
  llm::ChatRequest request = PhysicsQuestion(object_name, base);
  PhysicsAnswer answer;
  std::optional<ObjectAnswer> object;
  for (int attempt = 0; attempt < kAttempts && !object; ++attempt) {
    const llm::ChatAnswer said = model->Ask(request, progress);
    answer = ReadPhysicsAnswer(said.text);
    object = Usable(answer, object_name, known.category != nullptr);
    request.messages.push_back({llm::Role::kAssistant, said.text, {}});
    request.messages.push_back({llm::Role::kUser,
                                "That lacks a mass or a size that can be read. Give the four lines "
                                "as asked, with numbers.",
                                {}});
  }
  const std::string source =
      model->name().empty() ? "the language model" : "the language model " + model->name();
  EstimatedCategory estimate;
  if (known.category == nullptr) {
    estimate = CategoryFromAnswer(object_name, object.value_or(ObjectAnswer()), base, source);
  } else {
    estimate = ReconcileAnswer(known, object.value_or(ObjectAnswer()), base, source);
    if (!object) {
      estimate.findings.push_back({"llm-unreadable", core::Severity::kWarning, object_name,
                                   source + " gave no readable size or mass", 0.0});
    }
  }
  estimate.findings.insert(estimate.findings.begin(), answer.findings.begin(),
                           answer.findings.end());
  const core::Findings of_model = model->TakeFindings();
  estimate.findings.insert(estimate.findings.end(), of_model.begin(), of_model.end());
  return estimate;
}

}  // namespace simwright::physics_params
