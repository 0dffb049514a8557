#pragma once

#include "factory/factory_folder.h"
#include "factory/factory_plan.h"
#include "factory/factory_record.h"

namespace simwright::factory {

// Returns the number of tasks of a part of the plan: tasks_per_part, the last one the rest.
int AskedTasks(const FactoryPlan& plan, int part);

// Makes part `part` of a factory's tasks, by rules, each verified, from the assets of the part that
// were made. Parts beyond those of the plan make up for tasks that others lack.
TaskPartRecord MakeTaskPart(const FactoryPlan& plan, int part, int asked,
                            const FactoryFolder& folder);

// Joins the first `parts` parts to tasks.json, with names that no two tasks share. Returns the
// number of tasks.
int JoinTaskParts(int parts, const FactoryFolder& folder);

}  // namespace simwright::factory
