#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"
#include "scene/projection.h"
#include "sim/settling.h"

namespace simwright::scene {

// The slots of fruit and of cutlery, which leans in its crock.
std::set<std::string> SlotsThatMayLie();

// Gravity sways a little, and friction is a quarter of what it is then: what stands by friction
// alone, as cutlery upright in its crock or an avocado on its side, finds a place that holds in
// another engine, too. Of 24 breakfast tables 17 stood still in MuJoCo without, 23 with; of
// pantries 21 and 24.
sim::SettlingOptions SwayingSettling();

struct FeasibilityOptions {
  ProjectionOptions projection;
  sim::SettlingOptions settling = SwayingSettling();
  // m by which what hangs in the air is lowered onto what is beneath it, at most
  // (LowerOntoSupports); 0: it falls. For samples of a model, whose heights are off by centimetres.
  double lowering = 0.0;
  double tilted = 0.35;  // rad: what has tipped by more is dropped; bowls may lean a little
  // Slots of what may tip, as it lies as well as it stands.
  std::set<std::string> may_lie = SlotsThatMayLie();
  double penetration = 1e-4;  // m that parts of a finished scene may be in each other
  // Of settling, at most: what stood on what was dropped settles again, and what is still on its
  // way after the first has the second to come to rest.
  int passes = 6;
  int fewest = 3;  // free objects that a scene needs (Pfaff et al., appendix)

  bool IsValid(std::string* error) const;
};

// What physics makes of a scene.
struct FeasibleScene {
  // Enough objects, none in another by more than the penetration, all stable.
  bool sound = false;
  std::vector<DrawnObject> objects;  // as they came to rest; parents as in the draw, by new index
  int dropped = 0;                   // objects that fell, tipped or did not come to rest
  double moved = 0.0;                // m, the mean over those that were kept
  double penetration = 0.0;          // m, the deepest, of convex parts
  double drift = 0.0;                // m, the farthest over the watched time
  bool projected = false;            // Projection::feasible
};

// Moves the objects of a scene apart, lowers them and leaves them to gravity; drops what fell off
// or tipped, and from the second pass what does not come to rest, and lets the others settle again
// where any was. Welded ones stay as they are. Throws core::Error for a slot without an asset, or
// options that are not valid.
FeasibleScene MakeFeasible(const std::vector<DrawnObject>& objects, const Palette& palette,
                           const FeasibilityOptions& options = {});

}  // namespace simwright::scene
