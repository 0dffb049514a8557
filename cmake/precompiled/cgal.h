#pragma once

// Precompiled for geometry, the only module that uses CGAL.
#include "cmake/precompiled/standard.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
