// Materials as functions of space, the words that choose them, and exemplars.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.h"
#include "texture/materials/look_words.h"
#include "texture/materials/material_bake.h"
#include "texture/materials/named_materials.h"
#include "texture/materials/print_design.h"
#include "texture/painting/exemplar_bake.h"
#include "texture/painting/perceptual_distance.h"
#include "texture/painting/seam_step.h"
#include "texture/uv_atlas.h"

namespace simwright::texture {
namespace {

// A beaker about the vertical, 0.1 m high, of radius 0.04 m outside and 0.036 m inside.
core::TriangleMesh Beaker() {
  const double profile[][2] = {{0, 0},       {0.04, 0},      {0.04, 0.1},
                               {0.036, 0.1}, {0.036, 0.004}, {0, 0.004}};
  constexpr int kAround = 48, kRows = 6;
  core::TriangleMesh mesh;
  for (const auto& [radius, z] : profile) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * M_PI * k / kAround;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  for (int row = 0; row + 1 < kRows; ++row) {
    for (int k = 0; k < kAround; ++k) {
      const int a = row * kAround + k, b = row * kAround + (k + 1) % kAround;
      mesh.triangles.emplace_back(a, b, b + kAround);
      mesh.triangles.emplace_back(a, b + kAround, a + kAround);
    }
  }
  std::erase_if(mesh.triangles, [&](const Eigen::Vector3i& t) {
    const Eigen::Vector3d e1 = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    return e1.cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm() < 1e-12;
  });
  return mesh;
}

// The atlas is made for 256 texels and is used for other sizes too.
const std::vector<Eigen::Vector2f>& BeakerUvs() {
  static const std::vector<Eigen::Vector2f> kUvs = [] {
    AtlasOptions atlas;
    atlas.size = 256;
    return UnwrapToAtlas(Beaker(), atlas);
  }();
  return kUvs;
}

struct BakedBeaker {
  core::TexturedMesh mesh;
  TexelMap map;
  MaterialMaps maps;
};

BakedBeaker BakeBeaker(const std::string& material, std::uint64_t seed, int size = 256) {
  BakedBeaker baked;
  baked.mesh.mesh = Beaker();
  baked.mesh.corner_uvs = BeakerUvs();
  baked.map = MakeTexelMap(baked.mesh.mesh, baked.mesh.corner_uvs, size);
  const std::vector<int> one(baked.mesh.mesh.triangles.size(), 0);
  core::Rng rng = core::StreamRng(seed, 0);
  MaterialPlan plan;
  plan.materials = {NamedMaterial(material, &rng)};
  plan.inside_material = plan.handle_material = {-1};
  plan.frames = FramesOfLabels(baked.mesh.mesh, one, 1);
  plan.triangle_material = plan.triangle_frame = one;
  baked.maps = BakeMaterials(baked.mesh.mesh, baked.mesh.corner_uvs, baked.map, plan);
  baked.mesh.textures = {baked.maps.color};
  return baked;
}

TEST(Materials, ShowNoBordersOfCharts) {
  // A board shows its end grain at sharp edges, which are therefore left out.
  for (const char* name :
       {"oak", "ceramic", "marble", "steel", "leather", "linen", "apple", "cork"}) {
    const BakedBeaker baked = BakeBeaker(name, 3, 512);
    const SeamSteps steps = MeasureSeamSteps(baked.mesh, 0.7);
    EXPECT_GT(steps.seam_samples, 50) << name;
    EXPECT_LT(steps.Ratio(), 1.2) << name;  // of a few hundred places
  }
}

TEST(Materials, AreRepeatableAndDifferBySeed) {
  const BakedBeaker a = BakeBeaker("walnut", 1), b = BakeBeaker("walnut", 1);
  EXPECT_EQ(a.maps.color.pixels, b.maps.color.pixels);
  EXPECT_EQ(a.maps.normal.pixels, b.maps.normal.pixels);
  EXPECT_NE(a.maps.color.pixels, BakeBeaker("walnut", 2).maps.color.pixels);
}

TEST(Materials, MapsSayWhatIsMetal) {
  const BakedBeaker steel = BakeBeaker("stainless steel", 1), oak = BakeBeaker("oak", 1);
  EXPECT_TRUE(steel.maps.any_metal);
  EXPECT_FALSE(oak.maps.any_metal);
  double metal = 0.0, rough_steel = 0.0, rough_oak = 0.0, count = 0.0;
  for (std::size_t i = 0; i < steel.map.count(); ++i) {
    if (!steel.map.inside[i]) continue;
    ++count;
    metal += steel.maps.metallic.pixels[i] / 255.0;
    rough_steel += steel.maps.roughness.pixels[i] / 255.0;
    rough_oak += oak.maps.roughness.pixels[i] / 255.0;
    // Normals of the maps have length one, up to the rounding to bytes.
    Eigen::Vector3d normal;
    for (int c = 0; c < 3; ++c) normal[c] = oak.maps.normal.pixels[3 * i + c] / 127.5 - 1.0;
    ASSERT_NEAR(normal.norm(), 1.0, 0.02);
  }
  EXPECT_DOUBLE_EQ(metal / count, 1.0);
  EXPECT_NEAR(rough_steel / count, 0.28, 0.06);
  EXPECT_NEAR(rough_oak / count, 0.52, 0.10);
}

TEST(Materials, AllAreFiniteEverywhere) {
  PartFrame frame;
  frame.box =
      Eigen::AlignedBox3f(Eigen::Vector3f(-0.05f, -0.04f, 0), Eigen::Vector3f(0.05f, 0.04f, 0.1f));
  EXPECT_GT(MaterialNames().size(), 90u);
  for (const std::string& name : MaterialNames()) {
    core::Rng rng = core::StreamRng(1, 5);
    const SurfaceMaterial material = NamedMaterial(name, &rng);
    for (int i = 0; i < 200; ++i) {
      MaterialPoint point;
      for (int k = 0; k < 3; ++k) {
        point.position[k] = static_cast<float>(core::Uniform(rng, -0.06, 0.11));
      }
      point.normal = core::UniformDirection(rng).cast<float>();
      point.footprint = i % 2 == 0 ? 1e-4f : 4e-3f;
      const MaterialSample sample = EvaluateMaterial(material, frame, point);
      ASSERT_TRUE(sample.color.allFinite()) << name;
      ASSERT_GE(sample.color.minCoeff(), 0.0f) << name;
      ASSERT_LE(sample.color.maxCoeff(), 1.0f) << name;
      ASSERT_GE(sample.roughness, 0.04f) << name;
      ASSERT_LE(sample.roughness, 1.0f) << name;
      ASSERT_LT(std::abs(sample.height), 0.004f) << name;
    }
  }
  core::Rng rng = core::StreamRng(1, 6);
  EXPECT_THROW(NamedMaterial("unobtainium", &rng), core::Error);
}

// Far away a material is as light as near: detail below the texels fades, and does not alias.
TEST(Materials, KeepTheirMeanColourAtCoarseTexels) {
  const BakedBeaker fine = BakeBeaker("oak", 4, 512), coarse = BakeBeaker("oak", 4, 64);
  Eigen::Vector3d means[2];
  int at = 0;
  for (const BakedBeaker* baked : {&fine, &coarse}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (std::size_t i = 0; i < baked->map.count(); ++i) {
      if (!baked->map.inside[i]) continue;
      for (int c = 0; c < 3; ++c) sum[c] += baked->maps.color.pixels[3 * i + c];
      ++count;
    }
    means[at++] = sum / count;
  }
  EXPECT_LT((means[0] - means[1]).cwiseAbs().maxCoeff(), 8.0);
}

TEST(Materials, KnowTheInsideAndTheHandle) {
  const core::TriangleMesh mesh = Beaker();
  const std::vector<std::uint8_t> inside = InsideOfVessel(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) middle += mesh.vertices[mesh.triangles[t][k]] / 3.0;
    const bool expected = middle.head<2>().norm() < 0.0361 && middle.z() > 0.003;
    EXPECT_EQ(inside[t] != 0, expected) << middle.transpose();
  }
  const std::vector<int> one(mesh.triangles.size(), 0);
  const PartFrame frame = FramesOfLabels(mesh, one, 1).front();
  ASSERT_TRUE(frame.round);
  EXPECT_FALSE(IsOnHandle(frame, {0.0400f, 0, 0.05f}));
  EXPECT_TRUE(IsOnHandle(frame, {0.0420f, 0, 0.05f}));
}

TEST(LookWords, BelongToThePartThatIsNamed) {
  const LookWords words =
      ReadLookWords("A blue glazed mug with a white inside, a handle of black plastic, and fluffy",
                    {"handle", "lid"}, {"mug"});
  ASSERT_EQ(words.clauses.size(), 3u);
  EXPECT_EQ(words.clauses[0].target, "");
  EXPECT_TRUE(words.clauses[0].glazed);
  ASSERT_EQ(words.clauses[0].colors.size(), 1u);
  EXPECT_EQ(words.clauses[0].colors[0], *NamedColor("blue"));
  EXPECT_EQ(words.clauses[1].target, "inside");
  EXPECT_EQ(words.clauses[1].colors[0], *NamedColor("white"));
  EXPECT_EQ(words.clauses[2].target, "handle");
  EXPECT_EQ(words.clauses[2].material, "plastic");
  ASSERT_EQ(words.clauses[2].colors.size(), 1u);
  EXPECT_EQ(words.clauses[2].colors[0], *NamedColor("black"));
  EXPECT_EQ(words.unused, std::vector<std::string>{"fluffy"});
}

TEST(LookWords, ReadPhrasesPatternsAndTexts) {
  const LookWords words = ReadLookWords("worn dark green cast iron", {}, {});
  ASSERT_EQ(words.clauses.size(), 1u);
  EXPECT_EQ(words.clauses[0].material, "cast iron");
  EXPECT_EQ(words.clauses[0].colors[0], *NamedColor("dark green"));
  EXPECT_FLOAT_EQ(*words.clauses[0].wear, 0.6f);
  EXPECT_TRUE(words.unused.empty());
  const LookWords stripes = ReadLookWords("blue and white striped, \"OAT MILK\"", {}, {});
  ASSERT_EQ(stripes.clauses.size(), 2u);
  EXPECT_EQ(stripes.clauses[0].pattern, Pattern::kStripes);
  EXPECT_EQ(stripes.clauses[0].colors.size(), 2u);
  EXPECT_EQ(stripes.clauses[1].text, "OAT MILK");
  EXPECT_TRUE(ReadLookWords("", {}, {}).clauses.empty());
}

TEST(LookWords, ChangeAMaterial) {
  core::Rng rng = core::StreamRng(1, 1);
  const SurfaceMaterial base = NamedMaterial("plastic", &rng);
  LookClause clause;
  clause.material = "walnut";
  clause.roughness = 0.8f;
  SurfaceMaterial changed = WithWords(clause, base, &rng);
  EXPECT_EQ(changed.substance, Substance::kWood);
  EXPECT_FLOAT_EQ(changed.roughness, 0.8f);
  LookClause brushed;
  brushed.brushed = true;
  EXPECT_TRUE(WithWords(brushed, base, &rng).IsMetal());
  LookClause red;
  red.colors = {*NamedColor("red")};
  changed = WithWords(red, base, &rng);
  EXPECT_EQ(changed.substance, Substance::kPlastic);
  EXPECT_LT((changed.color - *NamedColor("red")).cwiseAbs().maxCoeff(), 0.12f);
}

// A swatch of two colours in patches of 8 pixels.
Swatch TwoColours() {
  Swatch swatch;
  swatch.picture = core::Image(96, 96, 3);
  core::Rng rng = core::StreamRng(3, 0);
  std::vector<std::uint8_t> dark(12 * 12);
  for (std::uint8_t& one : dark) one = core::Uniform(rng) < 0.4;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const bool is_dark = dark[static_cast<std::size_t>(y / 8 * 12 + x / 8)] != 0;
      for (int c = 0; c < 3; ++c) {
        swatch.picture.At(x, y)[c] =
            static_cast<std::uint8_t>(is_dark ? 40 + 30 * c : 200 - 10 * c);
      }
    }
  }
  swatch.pixel_size = 1e-3;
  return swatch;
}

struct Moments {
  Eigen::Vector3d mean{0, 0, 0}, deviation{0, 0, 0};
};

template <typename Counts>
Moments MomentsOf(const core::Image& image, const Counts& counts) {
  Moments moments;
  double count = 0.0;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; 3 * i < image.pixels.size(); ++i) {
    if (!counts(i)) continue;
    ++count;
    for (int c = 0; c < 3; ++c) {
      moments.mean[c] += image.pixels[3 * i + c];
      squares[c] += std::pow(image.pixels[3 * i + c], 2);
    }
  }
  moments.mean /= count;
  moments.deviation = (squares / count - moments.mean.cwiseAbs2()).cwiseSqrt();
  return moments;
}

TEST(Exemplar, AQuiltHasTheColoursOfItsSwatch) {
  const Swatch swatch = TwoColours();
  ExemplarGenerator generator(swatch);
  ImageRequest request;
  request.prompt = "exemplar";
  request.width = 300;
  request.height = 200;
  const core::Image quilt = generator.Generate(request);
  ASSERT_EQ(quilt.width, 300);
  ASSERT_EQ(quilt.height, 200);
  const auto all = [](std::size_t) { return true; };
  const Moments source = MomentsOf(swatch.picture, all), made = MomentsOf(quilt, all);
  EXPECT_LT((source.mean - made.mean).cwiseAbs().maxCoeff(), 16.0);
  EXPECT_LT((source.deviation - made.deviation).cwiseAbs().maxCoeff(), 12.0);
  // Most pixels are of the swatch; the others lie on cuts.
  std::size_t exact = 0;
  for (std::size_t i = 0; i < quilt.pixels.size(); i += 3) {
    exact += quilt.pixels[i] == 40 || quilt.pixels[i] == 200;
  }
  EXPECT_GT(exact, 0.85 * static_cast<double>(quilt.pixels.size() / 3));
  EXPECT_EQ(quilt.pixels, generator.Generate(request).pixels);
  request.seed = 2;
  EXPECT_NE(quilt.pixels, generator.Generate(request).pixels);
}

TEST(Exemplar, CoversTheSurfaceWithoutBorders) {
  core::TexturedMesh beaker;
  beaker.mesh = Beaker();
  beaker.corner_uvs = BeakerUvs();
  const TexelMap map = MakeTexelMap(beaker.mesh, beaker.corner_uvs, 512);
  Swatch swatch = TwoColours();
  swatch.pixel_size = 2e-3;
  beaker.textures = {BakeExemplar(beaker.mesh, map, swatch, 1)};
  EXPECT_LT(MeasureSeamSteps(beaker, 0.7).Ratio(), 1.1);
  const Moments source = MomentsOf(swatch.picture, [](std::size_t) { return true; });
  const Moments made =
      MomentsOf(beaker.textures.front(), [&](std::size_t i) { return map.inside[i] != 0; });
  EXPECT_LT((source.mean - made.mean).cwiseAbs().maxCoeff(), 20.0);
  EXPECT_GT((made.deviation.array() / source.deviation.array()).minCoeff(), 0.75);
}

TEST(Exemplar, TheLargestSquareAndItsShading) {
  core::Image picture(200, 160, 3), mask(200, 160, 1);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (x >= 20 && x < 140 && y >= 30 && y < 130) *mask.At(x, y) = 255;  // 120 x 100
      for (int c = 0; c < 3; ++c) {
        picture.At(x, y)[c] = static_cast<std::uint8_t>(60 + 0.6 * x);  // shaded from the left
      }
    }
  }
  double scale = 0.0;
  const core::Image square = LargestSwatch(picture, mask, 400, &scale);
  // Less 3 % of 120 pixels on each side.
  EXPECT_EQ(square.width, 100 - 2 * 3);
  EXPECT_EQ(square.height, square.width);
  EXPECT_DOUBLE_EQ(scale, 1.0);
  const auto all = [](std::size_t) { return true; };
  EXPECT_LT(MomentsOf(WithoutShading(square), all).deviation.maxCoeff(),
            0.5 * MomentsOf(square, all).deviation.maxCoeff());
  EXPECT_THROW(LargestSwatch(core::Image(20, 20, 3), {}, 400, &scale), core::Error);
}

TEST(PerceptualDistance, IsZeroForEqualPicturesAndKnowsBlackFromWhite) {
  core::Image black(200, 200, 3, 0), white(200, 200, 3, 255);
  EXPECT_NEAR(ComparePictures(black, black).structure, 0.0, 1e-6);
  EXPECT_NEAR(ComparePictures(black, black).color, 0.0, 1e-6);
  EXPECT_NEAR(ComparePictures(black, white).color, 100.0, 0.1);  // of lightness in CIELAB
  core::Image noisy = white;
  core::Rng rng = core::StreamRng(1, 0);
  for (std::uint8_t& value : noisy.pixels) value = static_cast<std::uint8_t>(rng() >> 56);
  EXPECT_GT(ComparePictures(white, noisy).structure, 0.5);
  EXPECT_THROW(ComparePictures(white, core::Image(64, 64, 3)), core::Error);
}

// Each character beyond ASCII is printed as one question mark, and they are counted.
TEST(Prints, CountCharactersThatTheFontLacks) {
  const auto print = [](const std::string& title) {
    core::Rng rng(3);
    return DrawPrint({title, "", 300, 200}, &rng).pixels;
  };
  EXPECT_EQ(CharactersWithoutGlyph("OAT MILK ~ 100 %"), 0);
  EXPECT_EQ(CharactersWithoutGlyph("CAF\xc3\x89 \xe8\x8c\xb6"), 2);
  EXPECT_EQ(print("CAF\xc3\x89 \xe8\x8c\xb6"), print("CAF? ?"));
  EXPECT_NE(print("CAFE"), print("CAF?"));
}

}  // namespace
}  // namespace simwright::texture
