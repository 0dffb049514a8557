#pragma once

#include <string>
#include <string_view>

#include "core/progress.h"
#include "llm/chat_model.h"
#include "physics_params/answer_reconciliation.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

// Returns the question about one category: ranges of mass in grams and of length, width and height
// in centimetres, as in Gen2Sim, and materials from the knowledge base's list.
llm::ChatRequest PhysicsQuestion(std::string_view name, const KnowledgeBase& base);

// Combines `model`'s answer about `name` with the knowledge base (ReconcileAnswer,
// CategoryFromAnswer). An unusable answer is requested once more; if the second is unusable too, a
// known category stays unchanged ("llm-unreadable", a warning), and an unknown one is a
// core::Error. `wordnet` may be null. Rethrows what `model` throws.
EstimatedCategory EstimateCategory(std::string_view name, const KnowledgeBase& base,
                                   const WordNet* wordnet, llm::ChatModel* model,
                                   core::Progress* progress = nullptr);

}  // namespace simwright::physics_params
