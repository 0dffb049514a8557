#pragma once

#include <vector>

#include "core/progress.h"
#include "library_fit/library_prior.h"
#include "twin/observed_object.h"
#include "twin/table_camera.h"
#include "twin/table_fit.h"

namespace simwright::twin {

// Objects on a table and the camera that sees them.
struct FittedTable {
  TableCamera camera;
  std::vector<TableFit> fits;  // one an object
  double loss = 0.0;           // of the fits at the best scale, and of the camera's improbability
};

// The scale at which objects have the most usual sizes.
struct ScaleChoice {
  double log_scale = 0.0;   // to be added to the logarithms of all lengths
  std::vector<int> choice;  // by object: the index of its best fit at this scale
  double score = 0.0;
  double error = 0.0;  // of log_scale: half the width in which the score rises by one nat
};

// Chooses the scale, and with it one of each object's alternative fits. `log_error`: the expected
// mean absolute error of the present scale; 0: the scale is known.
ScaleChoice ChooseScale(const std::vector<std::vector<TableFit>>& alternatives, double log_error);

// Searches for the camera with which the objects' fits agree best with the photo: along elevation,
// focal length and roll in turn, three cameras each, whose fits are refined, and the minimum of
// the parabola through their losses. Numbers of `guess` without an error stay.
FittedTable SearchCamera(const library_fit::LibraryPrior& prior,
                         const std::vector<ObservedObject>& objects, int width, int height,
                         const TableCameraGuess& guess, std::vector<TableFit> fits, int passes,
                         const TableFitOptions& options, core::Progress* progress);

}  // namespace simwright::twin
