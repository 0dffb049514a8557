#pragma once

namespace simwright::certificate {

// The distances (m) that a plan keeps: the simulated arm lags behind its commands, and the objects
// of a settled scene are known within their penetration tolerance.
struct ClearanceMargins {
  double arm = 0.004;
  double gripper = 0.0015;  // the hand and fingers, which work between objects
  double held = 0.0015;     // the held object
};

}  // namespace simwright::certificate
