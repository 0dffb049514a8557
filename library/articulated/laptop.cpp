#include <algorithm>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kLaptopLidGap = 0.0012;  // m, between the closed lid and the deck
constexpr double kRecess = 0.0025;        // m, depth of the keyboard's recess in the deck
constexpr double kBezel = 0.009;          // m

struct LaptopPlan {
  double deep, across, base, lid;  // m; the last two are thicknesses
};

// Adds the deck with a well for the keyboard; the touchpad is visual only.
void AddBase(Assembly* a, int body, const LaptopPlan& p, const Eigen::AlignedBox2d& well,
             const Matter& shell) {
  const double x = 0.5 * p.deep, y = 0.5 * p.across, floor = p.base - kRecess;
  a->Add(body, shell, Box({-x, -y, 0.0}, {x, y, floor}, 0.001));
  a->Add(body, shell, Box({-x, -y, floor}, {well.min().x(), y, p.base}, 0.0004));
  a->Add(body, shell, Box({well.max().x(), -y, floor}, {x, y, p.base}, 0.0004));
  a->Add(body, shell,
         Box({well.min().x(), -y, floor}, {well.max().x(), well.min().y(), p.base}, 0.0));
  a->Add(body, shell,
         Box({well.min().x(), well.max().y(), floor}, {well.max().x(), y, p.base}, 0.0));
  Matter pad = shell;
  pad.look = "touchpad";
  pad.color.head<3>() *= 0.85f;
  a->Paint(body, pad,
           Box({-x + 0.10 * p.deep, -0.16 * p.across, p.base - 0.001},
               {-x + 0.38 * p.deep, 0.16 * p.across, p.base + 0.0003}, 0.0));
}

void AddKeys(Assembly* a, int keyboard, const Eigen::AlignedBox2d& well, double floor) {
  constexpr int kRows = 5, kColumns = 13;
  const Eigen::Vector2d step = well.sizes().cwiseQuotient(Eigen::Vector2d(kRows, kColumns));
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Eigen::Vector2d corner = well.min() + step.cwiseProduct(Eigen::Vector2d(row, column));
      a->Paint(keyboard, BlackPlastic(),
               Box({corner.x() + 0.002, corner.y() + 0.002, floor + 0.001},
                   {corner.x() + step.x() - 0.001, corner.y() + step.y() - 0.001,
                    floor + kRecess - 0.0005},
                   0.0005));
    }
  }
}

}  // namespace

assets::ArticulatedAsset MakeLaptop(const Options& options) {
  Assembly a("laptop", "laptop", options);
  // The row's heights span open laptops: closed ones are 14 to 26 mm thick.
  const double thick = a.Draw(0.016, 0.026);
  const LaptopPlan p{a.parameters().width.sample, a.parameters().length.sample, 0.64 * thick,
                     0.36 * thick - kLaptopLidGap};
  const Matter shell = a.Bernoulli(0.6)
                           ? MatterOf("electronics", "aluminium", 0.74f, 0.75f, 0.77f)
                           : MatterOf("electronics", "dark_shell", 0.22f, 0.23f, 0.25f);
  const double x = 0.5 * p.deep, y = 0.5 * p.across;
  const Eigen::AlignedBox2d well(Eigen::Vector2d(-0.02 * p.deep, -y + 0.03),
                                 Eigen::Vector2d(x - 0.035, y - 0.03));
  const int body = a.AddRoot("body", "body");
  AddBase(&a, body, p, well, shell);
  const double floor = p.base - kRecess;
  JointPlan fixed;
  fixed.origin = {well.center().x(), 0.0, floor};
  const int keyboard = a.AddLink("keyboard", "keyboard", body, fixed);
  Matter plate = MatterOf("electronics", "key_plate", 0.16f, 0.16f, 0.17f);
  a.Add(keyboard, plate,
        Box({well.min().x() + 0.0002, well.min().y() + 0.0002, floor},
            {well.max().x() - 0.0002, well.max().y() - 0.0002, floor + 0.001}, 0.0));
  AddKeys(&a, keyboard, well, floor);

  JointPlan hinge;
  hinge.type = assets::JointType::kRevolute;
  hinge.origin = {x + 0.002, 0.0, p.base + 0.5 * kLaptopLidGap};
  hinge.axis = Eigen::Vector3d::UnitY();
  hinge.upper = a.Draw(2.0, 2.35);
  hinge.joint_resistance = SampleJointResistance(a.draws(), 0.3 * p.deep);
  const int lid = a.AddLink("lid", "lid", body, hinge);
  const double low = p.base + kLaptopLidGap, high = low + p.lid;
  a.Add(lid, shell, Box({-x, -y, low + 0.001}, {x, y, high}, 0.001));
  // A bezel surrounds the screen, which is slightly recessed.
  a.Add(lid, BlackPlastic(), Box({-x, -y, low}, {-x + kBezel, y, low + 0.001}, 0.0));
  a.Add(lid, BlackPlastic(), Box({x - 2 * kBezel, -y, low}, {x, y, low + 0.001}, 0.0));
  a.Add(lid, BlackPlastic(),
        Box({-x + kBezel, -y, low}, {x - 2 * kBezel, -y + kBezel, low + 0.001}, 0.0));
  a.Add(lid, BlackPlastic(),
        Box({-x + kBezel, y - kBezel, low}, {x - 2 * kBezel, y, low + 0.001}, 0.0));
  JointPlan seat;
  seat.origin = {-0.5 * kBezel, 0.0, low + 0.0005};
  const int screen = a.AddLink("screen", "screen", lid, seat);
  a.Add(screen, MatterOf("glass", "screen", 0.10f, 0.16f, 0.26f),
        Box({-x + kBezel, -y + kBezel, low + 0.0004}, {x - 2 * kBezel, y - kBezel, low + 0.001},
            0.0));
  return a.Finish("electronics");
}

}  // namespace simwright::library
