#pragma once

#include <string>
#include <string_view>

#include "core/progress.h"
#include "llm/chat_model.h"
#include "physics_params/answer_reconciliation.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

// The question about one kind of thing: ranges of mass in grams and of length, width and height in
// centimetres, as Gen2Sim asks for them, and materials out of the knowledge base's.
llm::ChatRequest PhysicsQuestion(std::string_view name, const KnowledgeBase& base);

// What `model` says of `name`, joined with what is known (ReconcileAnswer, CategoryFromAnswer). An
// answer that cannot be used is asked for once more; where that is none either, a known kind stays
// as it is ("llm-unreadable", a warning), and an unknown one is a core::Error. `wordnet` may be
// null. Throws also what `model` throws.
EstimatedCategory EstimateCategory(std::string_view name, const KnowledgeBase& base,
                                   const WordNet* wordnet, llm::ChatModel* model,
                                   core::Progress* progress = nullptr);

}  // namespace simwright::physics_params
