#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "asset_lift/radiance_field/field_adam.h"
#include "asset_lift/radiance_field/field_model.h"
#include "asset_lift/radiance_field/occupancy_grid.h"
#include "asset_lift/radiance_field/radiance_field.h"
#include "asset_lift/radiance_field/volume_rendering.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace simwright::asset_lift {
namespace {

// A small grid with dense and hashed levels.
RadianceFieldOptions SmallField(int features = 2) {
  RadianceFieldOptions options;
  options.grid.levels = 4;
  options.grid.features = features;
  options.grid.log2_table_size = 9;
  options.grid.base_resolution = 5;
  options.hidden = 16;
  return options;
}

// Makes features as large as training does, so that every part of the chain matters.
template <typename Real>
void Stir(BasicRadianceField<Real>* field) {
  core::Rng rng(5);
  for (std::size_t i = 0; i < field->table_size(); ++i) {
    field->parameters()[i] = static_cast<Real>(core::Uniform(rng, -0.5, 0.5));
  }
}

template <typename Real>
FieldBatch<Real> RandomBatch(core::Rng* rng) {
  FieldBatch<Real> batch;
  for (auto& axis : batch.position) {
    for (Real& x : axis) x = static_cast<Real>(core::Uniform(*rng, -1.0, 1.0));
  }
  return batch;
}

template <typename Real>
FieldBatchGradient<Real> RandomGradient(core::Rng* rng) {
  FieldBatchGradient<Real> gradient;
  for (int s = 0; s < kFieldBatch; ++s) {
    gradient.raw[s] = static_cast<Real>(core::Normal(*rng));
    gradient.density[s] = static_cast<Real>(core::Normal(*rng));
    for (int c = 0; c < 3; ++c) gradient.color[c][s] = static_cast<Real>(core::Normal(*rng));
  }
  return gradient;
}

double Dot(const FieldBatchGradient<double>& weights, const FieldBatch<double>& batch) {
  double sum = 0.0;
  for (int s = 0; s < kFieldBatch; ++s) {
    sum += weights.raw[s] * batch.raw[s] + weights.density[s] * batch.density[s];
    for (int c = 0; c < 3; ++c) sum += weights.color[c][s] * batch.color[c][s];
  }
  return sum;
}

// Compares the derivative of `loss` along random directions with `gradient`, by central
// differences. `parts`: ranges of parameters that are perturbed separately.
template <typename Loss>
void ExpectGradient(std::vector<double>* parameters, const std::vector<double>& gradient,
                    const std::vector<std::size_t>& bounds, const Loss& loss) {
  core::Rng rng(11);
  const std::vector<double> start = *parameters;
  for (std::size_t part = 0; part + 1 < bounds.size(); ++part) {
    for (int trial = 0; trial < 4; ++trial) {
      std::vector<double> direction(start.size(), 0.0);
      double expected = 0.0, size = 0.0;
      for (std::size_t i = bounds[part]; i < bounds[part + 1]; ++i) {
        direction[i] = core::Normal(rng);
        expected += direction[i] * gradient[i];
        size += gradient[i] * gradient[i];
      }
      constexpr double kStep = 1e-6;
      double sides[2];
      for (int side = 0; side < 2; ++side) {
        for (std::size_t i = bounds[part]; i < bounds[part + 1]; ++i) {
          (*parameters)[i] = start[i] + (side == 0 ? -kStep : kStep) * direction[i];
        }
        sides[side] = loss();
      }
      *parameters = start;
      ASSERT_GT(size, 0.0);
      // The tolerance is relative to the gradient's length, because a direction may be orthogonal
      // to it.
      EXPECT_NEAR((sides[1] - sides[0]) / (2 * kStep), expected, 1e-3 * std::sqrt(size))
          << "part " << part << ", trial " << trial;
    }
  }
}

std::vector<std::size_t> Parts(const BasicRadianceField<double>& field) {
  const std::size_t hidden = field.table_size() + field.layout().outputs() * field.options().hidden;
  return {0, field.table_size(), hidden, field.parameters().size()};
}

TEST(RadianceField, GradientIsThatOfFiniteDifferences) {
  for (const int features : {1, 2, 4}) {
    BasicRadianceField<double> field(SmallField(features), 3);
    Stir(&field);
    core::Rng rng(1);
    FieldBatch<double> batch = RandomBatch<double>(&rng);
    const FieldBatchGradient<double> weights = RandomGradient<double>(&rng);
    field.Evaluate(&batch);
    std::vector<double> gradient(field.parameters().size(), 0.0);
    field.AddGradient(batch, weights, gradient.data());
    ExpectGradient(&field.parameters(), gradient, Parts(field), [&] {
      FieldBatch<double> moved = batch;
      field.Evaluate(&moved);
      return Dot(weights, moved);
    });
  }
}

TEST(RadianceField, GradientOfASingleEntryIsThatOfFiniteDifferences) {
  BasicRadianceField<double> field(SmallField(), 3);
  Stir(&field);
  core::Rng rng(1);
  FieldBatch<double> batch = RandomBatch<double>(&rng);
  const FieldBatchGradient<double> weights = RandomGradient<double>(&rng);
  field.Evaluate(&batch);
  std::vector<double> gradient(field.parameters().size(), 0.0);
  field.AddGradient(batch, weights, gradient.data());
  int touched = 0;
  for (std::size_t i = 0; i < gradient.size(); i += 7) {
    const double start = field.parameters()[i];
    double sides[2];
    for (int side = 0; side < 2; ++side) {
      field.parameters()[i] = start + (side == 0 ? -1e-6 : 1e-6);
      FieldBatch<double> moved = batch;
      field.Evaluate(&moved);
      sides[side] = Dot(weights, moved);
    }
    field.parameters()[i] = start;
    EXPECT_NEAR((sides[1] - sides[0]) / 2e-6, gradient[i], 1e-3 * std::abs(gradient[i]) + 1e-6);
    touched += gradient[i] != 0.0;
  }
  EXPECT_GT(touched, 50);
}

// Each instruction set, in single precision, against the plain loops in double precision; with the
// default sizes, which have code of their own, and with others.
TEST(RadianceField, AllInstructionSetsAgreeWithDoublePrecision) {
  RadianceFieldOptions biased = SmallField();
  biased.density_bias = [](const Eigen::Vector3d& p) { return 3.0 * p.x() - 2.0 * p.z(); };
  for (const RadianceFieldOptions& options :
       {RadianceFieldOptions(), SmallField(1), SmallField(4), biased}) {
    BasicRadianceField<double> exact(options, 3);
    RadianceField field(options, 3);
    Stir(&exact);
    Stir(&field);
    core::Rng rng(2);
    FieldBatch<double> exact_batch = RandomBatch<double>(&rng);
    FieldBatch<float> batch;
    for (int a = 0; a < 3; ++a) {
      for (int s = 0; s < kFieldBatch; ++s) {
        batch.position[a][s] = static_cast<float>(exact_batch.position[a][s]);
        exact_batch.position[a][s] = batch.position[a][s];
      }
    }
    core::Rng rng_a(4), rng_b(4);
    const auto exact_weights = RandomGradient<double>(&rng_a);
    const auto weights = RandomGradient<float>(&rng_b);
    std::vector<double> exact_sum(exact.parameters().size(), 0.0);
    PlainFieldKernels<double>().evaluate(exact.Model(), &exact_batch);
    PlainFieldKernels<double>().add_gradient(exact.Model(), exact_batch, exact_weights,
                                             exact_sum.data());
    std::vector<FieldKernels<float>> sets = {PlainFieldKernels<float>()};
    if (RadianceField::UsesAvx2()) sets.push_back(Avx2FieldKernels<float>());
    for (const FieldKernels<float>& kernels : sets) {
      kernels.evaluate(field.Model(), &batch);
      for (int s = 0; s < kFieldBatch; ++s) {
        EXPECT_NEAR(batch.raw[s], exact_batch.raw[s], 2e-4);
        EXPECT_NEAR(batch.density[s], exact_batch.density[s], 2e-4);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(batch.color[c][s], exact_batch.color[c][s], 1e-4);
      }
      std::vector<float> sum(field.parameters().size(), 0.0f);
      kernels.add_gradient(field.Model(), batch, weights, sum.data());
      double error = 0.0, size = 0.0;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        error += std::pow(sum[i] - exact_sum[i], 2);
        size += std::pow(exact_sum[i], 2);
      }
      EXPECT_LT(std::sqrt(error / size), 1e-3);
    }
  }
}

TEST(RadianceField, BiasGivenAsAFunctionIsReadInTheWorld) {
  RadianceFieldOptions options;
  options.center = {1.0, 2.0, 3.0};
  options.half_side = 0.25;
  options.density_scale = 3.0;
  options.density_bias = [](const Eigen::Vector3d& p) { return 40.0 * (p.z() - 3.0) + 2.0; };
  RadianceField field(options, 1);
  for (float& p : field.parameters()) p = 0.0f;
  // 3 softplus(2), 3 softplus(6), and nothing beyond the cube; per metre.
  const std::vector<float> density =
      field.DensityAt({{1.0, 2.0, 3.0}, {1.1, 1.9, 3.1}, {1.0, 2.0, 3.3}});
  EXPECT_NEAR(density[0], 3.0 * std::log1p(std::exp(2.0)) / 0.25, 1e-3);
  EXPECT_NEAR(density[1], 3.0 * std::log1p(std::exp(6.0)) / 0.25, 1e-3);
  EXPECT_EQ(density[2], 0.0f);
}

TEST(RadianceField, RefusesOptionsThatCannotBe) {
  RadianceFieldOptions options;
  options.hidden = 12;
  EXPECT_THROW(RadianceField(options, 1), core::Error);
  options = {};
  options.half_side = NAN;
  EXPECT_THROW(RadianceField(options, 1), core::Error);
  options = {};
  options.grid.features = 3;
  EXPECT_THROW(RadianceField(options, 1), core::Error);
  options = {};
  options.grid.scale = 9.0;
  EXPECT_THROW(RadianceField(options, 1), core::Error);
  options = {};
  options.density_bias = [](const Eigen::Vector3d&) { return NAN; };
  EXPECT_THROW(RadianceField(options, 1), core::Error);
}

// Returns rays from outside towards points within the cube.
std::vector<FieldRay> RaysThrough(int count, double spread) {
  core::Rng rng(9);
  std::vector<FieldRay> rays;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d from = 1.5 * core::UniformDirection(rng);
    rays.push_back({from, spread * core::UniformDirection(rng) - from});
  }
  return rays;
}

TEST(VolumeRendering, GradientOfARayIsThatOfFiniteDifferences) {
  BasicRadianceField<double> field(SmallField(), 3);
  Stir(&field);
  VolumeRenderOptions options;
  options.normals = true;
  options.min_transmittance = 0.0;
  VolumeRenderer<double> renderer(options);
  const OccupancyGrid everywhere;
  const std::vector<FieldRay> rays = RaysThrough(100, 0.2);
  RayRenderings<double> pictures, weights;
  weights.Resize(rays.size());
  core::Rng rng(8);
  const auto loss = [&] {
    renderer.Render(field, everywhere, rays, 77, &pictures);
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.color.size(); ++i) {
      sum += weights.color[i] * pictures.color[i] + weights.normal[i] * pictures.normal[i];
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      sum += weights.opacity[i] * pictures.opacity[i] + weights.depth[i] * pictures.depth[i];
    }
    return sum;
  };
  const std::vector<std::vector<double>*> each = {&weights.color, &weights.opacity, &weights.depth,
                                                  &weights.normal};
  for (std::vector<double>* alone : each) {
    for (std::vector<double>* w : each) {
      for (double& x : *w) x = w == alone ? core::Normal(rng) : 0.0;
    }
    loss();
    FieldGradient<double> gradient;
    renderer.AddGradient(field, weights, &gradient);
    std::vector<double> sum(field.parameters().size(), 0.0);
    for (const auto& part : gradient.parts) {
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
    }
    ExpectGradient(&field.parameters(), sum, Parts(field), loss);
  }
}

// Returns a field whose density is the bias alone.
RadianceField OnlyBias(const RadianceFieldOptions& options) {
  RadianceField field(options, 1);
  for (float& p : field.parameters()) p = 0.0f;
  return field;
}

TEST(VolumeRendering, HomogeneousCubeLosesLightWithTheChord) {
  RadianceFieldOptions options;
  options.half_side = 0.4;
  options.density_scale = 1.0;
  options.density_bias = [](const Eigen::Vector3d&) { return 0.7; };
  const RadianceField field = OnlyBias(options);
  const double density = std::log1p(std::exp(0.7)) / 0.4;
  VolumeRenderer<float> renderer({});
  RayRenderings<float> pictures;
  // Straight through, on the diagonal of a face, from within, and past it.
  const std::vector<FieldRay> rays = {{{-2, 0.1, 0.05}, {1, 0, 0}},
                                      {{-2, -2, 0.1}, {3, 3, 0}},
                                      {{0, 0, 0}, {0, 0, 0.5}},
                                      {{-2, 0.5, 0}, {1, 0, 0}}};
  renderer.Render(field, OccupancyGrid(), rays, 1, &pictures);
  const double chords[] = {0.8, 0.8 * std::sqrt(2.0), 0.4, 0.0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(pictures.opacity[i], 1.0 - std::exp(-density * chords[i]), 1e-3);
  }
  EXPECT_NEAR(pictures.color[0], 0.5 * pictures.opacity[0], 1e-4);  // sigmoid(0)
  // The mean depth where light is lost, by integration of sigma e^(-sigma x) x.
  const double lost = 1.0 - std::exp(-density * 0.8);
  const double mean = 1.0 / density - 0.8 * (1.0 - lost) / lost;
  EXPECT_NEAR(pictures.depth[0] / pictures.opacity[0], 1.6 + mean, 5e-3);
}

TEST(VolumeRendering, HomogeneousSphereLosesLightWithTheChord) {
  RadianceFieldOptions options;
  options.half_side = 1.0;
  options.density_scale = 1.0;
  constexpr double kRadius = 0.7;
  // Density log(1 + e) within, none outside, half of it at the radius; the fall from one to the
  // other takes a cell of the table.
  options.density_bias = [](const Eigen::Vector3d& p) {
    const double inward = (kRadius - p.norm()) / 0.03125;
    return 1.0 - 15.0 * std::clamp(0.0716 - inward, 0.0, 1.0);
  };
  const RadianceField field = OnlyBias(options);
  const double density = std::log1p(std::exp(1.0));
  VolumeRenderer<float> renderer({});
  OccupancyGrid occupancy;
  occupancy.Update(field, {}, 3);
  EXPECT_LT(occupancy.OccupiedShare(), 0.25);  // of the sphere: 0.18
  core::Rng rng(3);
  std::vector<FieldRay> rays;
  std::vector<double> chords;
  for (int i = 0; i < 200; ++i) {
    const double off = 0.5 * core::Uniform(rng);
    const Eigen::Vector3d along = core::UniformDirection(rng);
    const Eigen::Vector3d aside = along.unitOrthogonal();
    rays.push_back({off * aside - 3.0 * along, along});
    chords.push_back(2.0 * std::sqrt(kRadius * kRadius - off * off));
  }
  RayRenderings<float> pictures;
  renderer.Render(field, occupancy, rays, 5, &pictures);
  double sum = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double error = pictures.opacity[i] - (1.0 - std::exp(-density * chords[i]));
    EXPECT_LT(std::abs(error), 0.04) << chords[i];
    sum += std::abs(error);
  }
  EXPECT_LT(sum / rays.size(), 0.01);
}

// Returns the light absorbed by the default blob: log(1 + e^(scale (1 - r / std))) integrated along
// the chord in ten thousand steps.
TEST(VolumeRendering, BlobLosesLightAndFacesOutward) {
  RadianceFieldOptions options;
  options.half_side = 1.0;
  options.density_scale = 1.0;
  options.blob_scale = 60.0;
  const RadianceField field = OnlyBias(options);
  VolumeRenderOptions render;
  render.normals = true;
  VolumeRenderer<float> renderer(render);
  std::vector<FieldRay> rays;
  for (int i = 1; i < 20; ++i) rays.push_back({{-3.0, 0.025 * i, 0.0}, {1.0, 0.0, 0.0}});
  RayRenderings<float> pictures;
  renderer.Render(field, OccupancyGrid(), rays, 5, &pictures);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double b = rays[i].origin.y();
    double lost = 0.0;
    for (int n = 0; n < 10000; ++n) {
      const double along = (n + 0.5) * 2e-4 - 1.0;
      lost += 2e-4 * std::log1p(std::exp(60.0 * (1.0 - std::hypot(b, along) / 0.5)));
    }
    EXPECT_NEAR(pictures.opacity[i], 1.0 - std::exp(-lost), 0.03) << b;
    if (pictures.opacity[i] < 0.2f) continue;
    // Outward: against the ray, and within the plane of the ray and the centre.
    EXPECT_LT(pictures.normal[3 * i], 0.05f);
    EXPECT_NEAR(pictures.normal[3 * i + 2], 0.0f, 0.03f);
    EXPECT_NEAR(Eigen::Map<Eigen::Vector3f>(&pictures.normal[3 * i]).norm(), 1.0f, 1e-5f);
  }
}

TEST(VolumeRendering, PicturesDoNotDependOnThreadsAndEmptyCellsDoNotMatter) {
  const RadianceField field(RadianceFieldOptions(), 4);
  const std::vector<FieldRay> rays = RaysThrough(300, 0.25);
  OccupancyGrid occupancy;
  VolumeRenderer<float> renderer({});
  RayRenderings<float> all, one, skipping;
  renderer.Render(field, occupancy, rays, 6, &all);
  core::SetThreadCount(1);
  renderer.Render(field, occupancy, rays, 6, &one);
  core::SetThreadCount(0);
  EXPECT_EQ(all.color, one.color);
  const std::int64_t before = renderer.samples();
  for (int i = 0; i < 3; ++i) occupancy.Update(field, {}, i);
  renderer.Render(field, occupancy, rays, 6, &skipping);
  EXPECT_LT(renderer.samples(), before);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_NEAR(skipping.opacity[i], all.opacity[i], 0.06);
  }
  std::vector<std::uint8_t> nowhere(64 * 64 * 64, 0);
  occupancy.Restrict(nowhere);
  renderer.Render(field, occupancy, rays, 6, &skipping);
  EXPECT_EQ(renderer.samples(), 0);
  EXPECT_EQ(skipping.opacity, std::vector<float>(rays.size(), 0.0f));
}

TEST(VolumeRendering, RefusesRaysAndOptionsThatCannotBe) {
  const RadianceField field(RadianceFieldOptions(), 4);
  VolumeRenderer<float> renderer({});
  RayRenderings<float> pictures;
  EXPECT_THROW(renderer.Render(field, OccupancyGrid(), {{{0, 0, NAN}, {1, 0, 0}}}, 1, &pictures),
               core::Error);
  EXPECT_THROW(renderer.Render(field, OccupancyGrid(), {{{0, 0, 1}, {0, 0, 0}}}, 1, &pictures),
               core::Error);
  renderer.Render(field, OccupancyGrid(), {{{0, 0, 1}, {1, 0, 0}}}, 1, &pictures);
  RayRenderings<float> other;
  other.Resize(7);
  FieldGradient<float> gradient;
  EXPECT_THROW(renderer.AddGradient(field, other, &gradient), core::Error);
  VolumeRenderOptions options;
  options.max_samples = 65;
  EXPECT_THROW(VolumeRenderer<float>{options}, core::Error);
  OccupancyGrid grid;
  EXPECT_THROW(grid.Restrict({1, 2, 3}), core::Error);
}

TEST(FieldAdam, StepsByTheRateAgainstTheGradientAndRefusesNan) {
  RadianceField field(SmallField(), 1);
  const std::vector<float> start = field.parameters();
  FieldGradient<float> gradient;
  gradient.Prepare(field);
  for (auto& part : gradient.parts) part[3] = 0.25f;
  gradient.parts.back()[4] = -2.0f;
  FieldAdam adam;
  EXPECT_TRUE(adam.Step(0.01, &field, &gradient));
  // Adam's first step has the rate's length whatever the gradient's size.
  EXPECT_NEAR(field.parameters()[3], start[3] - 0.01f, 1e-6);
  EXPECT_NEAR(field.parameters()[4], start[4] + 0.01f, 1e-6);
  EXPECT_EQ(field.parameters()[5], start[5]);
  for (const auto& part : gradient.parts) EXPECT_EQ(part[3], 0.0f);
  // Second step, gradient -1 after 0.25 parts in sum g: m = .9 (.1 g) - .1, v likewise.
  const double g = 0.25 * gradient.parts.size();
  gradient.parts[0][3] = -1.0f;
  EXPECT_TRUE(adam.Step(0.01, &field, &gradient));
  const double mean = (0.9 * 0.1 * g - 0.1) / (1 - 0.81);
  const double square = (0.99 * 0.01 * g * g + 0.01) / (1 - 0.9801);
  EXPECT_NEAR(field.parameters()[3], start[3] - 0.01 - 0.01 * mean / std::sqrt(square), 1e-6);
  const std::vector<float> before = field.parameters();
  gradient.parts[0][7] = NAN;
  EXPECT_FALSE(adam.Step(0.01, &field, &gradient));
  EXPECT_EQ(field.parameters(), before);
  EXPECT_EQ(gradient.parts[0][7], 0.0f);
}

}  // namespace
}  // namespace simwright::asset_lift
