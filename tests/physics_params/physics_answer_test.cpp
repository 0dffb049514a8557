// Language models' answers to questions about masses and sizes, in every form seen so far.
#include "physics_params/physics_answer.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <sstream>
#include <string>

#include "physics_params/measure_text.h"

namespace simwright::physics_params {
namespace {

// Returns the only object of an answer.
ObjectAnswer Only(const std::string& text) {
  const PhysicsAnswer answer = ReadPhysicsAnswer(text);
  EXPECT_EQ(answer.objects.size(), 1u) << text;
  return answer.objects.empty() ? ObjectAnswer() : answer.objects[0];
}

void PhysicsAnswerExpectRange(const std::optional<Interval>& range, double min, double max,
                              const std::string& text) {
  ASSERT_TRUE(range.has_value()) << text;
  EXPECT_NEAR(range->min, min, 1e-9 * max) << text;
  EXPECT_NEAR(range->max, max, 1e-9 * max) << text;
}

// Grams.
void ExpectMass(const std::string& text, double min, double max) {
  PhysicsAnswerExpectRange(Only(text).mass, 1e-3 * min, 1e-3 * max, text);
}

// Centimetres.
void ExpectSizes(const std::string& text, const std::array<double, 6>& sizes) {
  const ObjectAnswer object = Only(text);
  PhysicsAnswerExpectRange(object.length, 1e-2 * sizes[0], 1e-2 * sizes[1], text);
  PhysicsAnswerExpectRange(object.width, 1e-2 * sizes[2], 1e-2 * sizes[3], text);
  PhysicsAnswerExpectRange(object.height, 1e-2 * sizes[4], 1e-2 * sizes[5], text);
}

// Gen2Sim, table I: a language model's answers in grams and centimetres.
struct TableRow {
  const char* name;
  std::array<double, 8> values;
};
constexpr TableRow kGen2Sim[] = {
    {"Papaya", {500, 1000, 15, 20, 10, 15, 10, 15}},
    {"Cucumber", {200, 300, 15, 20, 5, 7, 5, 7}},
    {"Watermelon", {5000, 7000, 30, 40, 20, 30, 20, 30}},
    {"Raspberry", {3, 5, 2, 3, 2, 3, 2, 3}},
    {"Coconut", {600, 800, 10, 15, 8, 12, 8, 12}},
    {"Corn", {50, 100, 10, 15, 8, 12, 8, 12}},
    {"Pumpkin", {2000, 5000, 20, 40, 20, 40, 20, 40}},
    {"Avocado", {150, 250, 10, 12, 6, 8, 4, 5}},
};

std::string Number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// One row in the published form of answer, with `dash` in its ranges.
std::string Published(const TableRow& row, const std::string& dash) {
  const auto range = [&](int i) {
    return Number(row.values[static_cast<std::size_t>(i)]) + dash +
           Number(row.values[static_cast<std::size_t>(i) + 1]);
  };
  return std::string("Average mass of ") + row.name + " in grams: " + range(0) +
         "\nAverage length, width, height of " + row.name + " in centimeters: " + range(2) + ", " +
         range(4) + ", " + range(6) + "\n";
}

TEST(PhysicsAnswer, Gen2SimTableOneIsReadExactly) {
  for (const std::string dash : {"-", " - ", "\u2013", " to "}) {
    std::string all;
    for (const TableRow& row : kGen2Sim) all += Published(row, dash);
    const PhysicsAnswer answer = ReadPhysicsAnswer(all);
    ASSERT_EQ(answer.objects.size(), std::size(kGen2Sim));
    EXPECT_TRUE(answer.findings.empty());
    for (std::size_t i = 0; i < std::size(kGen2Sim); ++i) {
      const TableRow& row = kGen2Sim[i];
      const ObjectAnswer& object = answer.objects[i];
      EXPECT_EQ(object.name, NormaliseName(row.name));
      EXPECT_EQ(FindObject(answer, row.name), &object);
      PhysicsAnswerExpectRange(object.mass, 1e-3 * row.values[0], 1e-3 * row.values[1], row.name);
      PhysicsAnswerExpectRange(object.length, 1e-2 * row.values[2], 1e-2 * row.values[3], row.name);
      PhysicsAnswerExpectRange(object.width, 1e-2 * row.values[4], 1e-2 * row.values[5], row.name);
      PhysicsAnswerExpectRange(object.height, 1e-2 * row.values[6], 1e-2 * row.values[7], row.name);
    }
  }
}

TEST(PhysicsAnswer, MassesInEveryWriting) {
  ExpectMass("Mass: 200-300 g", 200, 300);
  ExpectMass("mass in grams: 200 \u2014 300", 200, 300);
  ExpectMass("Mass: 200\u2212300", 200, 300);
  ExpectMass("**Mass:** 200 to 300 grams", 200, 300);
  ExpectMass("* **Weight**: ~200\u2013300 g (0.44\u20130.66 lb)", 200, 300);
  ExpectMass("It weighs between 200 and 300 grams.", 200, 300);
  ExpectMass("Mass: 0.2 kg - 300 g", 200, 300);
  ExpectMass("Mass: 200g-0.3kg", 200, 300);
  ExpectMass("Mass (kg): 0.2-0.3", 200, 300);
  ExpectMass("Mass: .2 kg", 200, 200);
  ExpectMass("Average mass of mug in kilograms: 0.25", 250, 250);
  ExpectMass("Mass: 1,200-1,500 g", 1200, 1500);
  ExpectMass("Mass: 12,000 g", 12000, 12000);
  ExpectMass("Mass: 0,2-0,3 kg", 200, 300);
  ExpectMass("Mass: 250 \u00b1 50 g", 200, 300);
  ExpectMass("Mass: 1-2 lb", 453.59237, 907.18474);
  ExpectMass("Mass: 16 oz", 453.59237, 453.59237);
  ExpectMass("Mass: 2.5e2 g", 250, 250);
  ExpectMass("Average mass of pound cake in grams: 400-500", 400, 500);
  ExpectMass("Average mass of 2-liter bottle in grams: 2000-2200", 2000, 2200);
  ExpectMass("The average mass of a mug is 300 g.", 300, 300);
}

TEST(PhysicsAnswer, SizesInEveryWriting) {
  const std::array<double, 6> mug = {10, 12, 8, 9, 7, 8};
  ExpectSizes("Average length, width, height of mug in centimeters: 10-12, 8-9, 7-8", mug);
  ExpectSizes("Length, width, height: 10-12 x 8-9 x 7-8 cm", mug);
  ExpectSizes("Dimensions: 10\u201312 \u00d7 8\u20139 \u00d7 7\u20138 cm", mug);
  ExpectSizes("Dimensions (L x W x H): 100-120 mm x 80-90 mm x 70-80 mm", mug);
  ExpectSizes("Dimensions (length, width, height) in m: 0.1-0.12, 0.08-0.09, 0.07-0.08", mug);
  ExpectSizes("Height, width, length: 7-8, 8-9, 10-12", mug);
  ExpectSizes("- Length: 10-12 cm\n- Width: 8-9 cm\n- Height: 7-8 cm", mug);
  ExpectSizes("Length 10-12 cm, width 8-9 cm, and height 7-8 cm", mug);
  ExpectSizes("It is 10 to 12 cm long, 8 to 9 cm wide and 7 to 8 cm tall.", mug);
  ExpectSizes("Length: 0.1 m to 12 cm; width: 8-9; height: 70 mm - 8 cm", mug);
  ExpectSizes("Length, width, height: 10-12,8-9,7-8", mug);
  ExpectSizes("Length, width, height: 10,5-12 x 8-9 x 7-8 cm", {10.5, 12, 8, 9, 7, 8});
  ExpectSizes("Length, width, height: 2-3 each", {2, 3, 2, 3, 2, 3});
  ExpectSizes("Diameter: 8-9 cm, height: 7-8 cm", {8, 9, 8, 9, 7, 8});
  ExpectSizes("Dimensions: 10 x 8 x 7 inches", {25.4, 25.4, 20.32, 20.32, 17.78, 17.78});
  ExpectSizes("Length: 10\", Width: 8\", Height: 7\"", {25.4, 25.4, 20.32, 20.32, 17.78, 17.78});
  ExpectSizes("Length, width, height: 20,100,300", {20, 20, 100, 100, 300, 300});
  ExpectSizes("Length: 1,200 mm, width: 80 cm, height: 0.5 m", {120, 120, 80, 80, 50, 50});
}

constexpr std::array<double, 6> kMug = {10, 12, 8, 9, 7, 8};

TEST(PhysicsAnswer, JsonInEveryShape) {
  for (const std::string text :
       {R"j({"mass_g": [300, 400], "length_cm": [10, 12], "width_cm": [8, 9],
             "height_cm": [7, 8]})j",
        R"j({"mass": "300-400 g", "dimensions": "10-12 x 8-9 x 7-8 cm"})j",
        R"j({"mass": {"min": 300, "max": 400, "unit": "g"},
             "dimensions": {"length": {"min": 0.10, "max": 0.12, "unit": "m"},
                            "width": "8-9 cm", "height": [7, 8]}})j",
        R"j({"mass": {"grams": [300, 400]}, "size_cm": [[10, 12], [8, 9], [7, 8]]})j",
        R"j([{"object": "mug", "weight (kg)": "0.3-0.4", "length": "10-12", "width": "8-9",
              "height": "7-8", "material": "ceramic"}])j",
        R"j(Here it is:
```json
{"mug": {"mass_in_grams": "300-400", "length, width, height in cm": "10-12, 8-9, 7-8",},}
```
Note [1]: weights vary.)j"}) {
    ExpectMass(text, 300, 400);
    ExpectSizes(text, kMug);
  }
}

TEST(PhysicsAnswer, TablesInEitherDirection) {
  const std::string across =
      "| Object | Mass (g) | Length (cm) | Width (cm) | Height (cm) |\n"
      "|:---|---:|---|---|---|\n"
      "| **Mug** | 300-400 | 10-12 | 8-9 | 7-8 |\n"
      "| Plate | 500 | 25 | 25 | 2-3 |\n";
  const PhysicsAnswer answer = ReadPhysicsAnswer(across);
  ASSERT_EQ(answer.objects.size(), 2u);
  EXPECT_EQ(answer.objects[0].name, "mug");
  PhysicsAnswerExpectRange(answer.objects[0].mass, 0.3, 0.4, across);
  PhysicsAnswerExpectRange(answer.objects[0].height, 0.07, 0.08, across);
  PhysicsAnswerExpectRange(answer.objects[1].mass, 0.5, 0.5, across);
  PhysicsAnswerExpectRange(answer.objects[1].height, 0.02, 0.03, across);
  const std::string down =
      "| Property | Value |\n|---|---|\n| Mass | 300\u2013400 g |\n| Length | 10-12 cm |\n"
      "| Width | 8-9 cm |\n| Height | 7-8 cm |\n| Material | ceramic |\n";
  ExpectMass(down, 300, 400);
  ExpectSizes(down, kMug);
  EXPECT_EQ(Only(down).material, "ceramic");
}

TEST(PhysicsAnswer, ProseAroundAndSeveralObjects) {
  const std::string text =
      "Sure! Here are my estimates for 2 objects:\n\n### 1. Coffee Mug\n"
      "- **Mass**: 300-400 g\n- **Length**: 10-12 cm\n- **Width**: 8-9 cm\n- **Height**: 7-8 cm\n"
      "- Material: glazed ceramic\n\n**Plate:**\nMass in grams: 400-600\n"
      "Length, width, height in cm: 25-27, 25-27, 2-3\nThese depend on the high quality of make.";
  const PhysicsAnswer answer = ReadPhysicsAnswer(text);
  ASSERT_EQ(answer.objects.size(), 2u);
  EXPECT_EQ(answer.objects[0].name, "coffee mug");
  EXPECT_EQ(answer.objects[0].material, "glazed ceramic");
  PhysicsAnswerExpectRange(answer.objects[0].width, 0.08, 0.09, text);
  EXPECT_EQ(answer.objects[1].name, "plate");
  PhysicsAnswerExpectRange(answer.objects[1].mass, 0.4, 0.6, text);
  EXPECT_EQ(FindObject(answer, "Plate"), &answer.objects[1]);
  EXPECT_EQ(FindObject(answer, "red coffee mug"), &answer.objects[0]);
  EXPECT_EQ(FindObject(answer, "violin"), nullptr);
}

TEST(PhysicsAnswer, NonsenseIsReportedAndDropped) {
  const auto code_of = [](const std::string& text) {
    const PhysicsAnswer answer = ReadPhysicsAnswer(text);
    return answer.findings.size() == 1 ? answer.findings[0].code : "none";
  };
  EXPECT_EQ(code_of("Mass: -5 g"), "answer-negative");
  EXPECT_EQ(code_of("Length: -5-10 cm"), "answer-negative");
  EXPECT_EQ(code_of("Mass: 0 g"), "answer-negative");
  EXPECT_EQ(code_of("Length, width, height: 10-12, 8-9"), "answer-unclear");
  EXPECT_EQ(code_of("Mass: 300-200 g"), "answer-swapped");
  ExpectMass("Mass: 300-200 g", 200, 300);
  for (const std::string text :
       {"", "I cannot know.", "Mass: heavy", "Mass: 5 cm", "Length: 5 kg", "Mass: nan", "Mass: inf",
        "mass 1e999 g", "A4 paper has the size of a page", "{}", "[]", "{\"mass\": null}",
        "||||"}) {
    EXPECT_TRUE(ReadPhysicsAnswer(text).objects.empty()) << text;
  }
}

TEST(PhysicsAnswer, LongTextsAreReadInLinearTime) {
  for (const std::string piece : {"mass: 1-", "{\"mass\":", "|mass|1", "length, ", "1,1,1 "}) {
    std::string text;
    while (text.size() < (1u << 20)) text += piece;
    ReadPhysicsAnswer(text);  // bounded by the test's time limit
  }
}

TEST(MeasureText, UnitsAreExact) {
  EXPECT_DOUBLE_EQ(FindUnit("lb")->factor, 0.45359237);
  EXPECT_DOUBLE_EQ(FindUnit("inches")->factor, 0.0254);
  EXPECT_DOUBLE_EQ(FindUnit("feet")->factor, 0.3048);
  EXPECT_FALSE(FindUnit("stone").has_value());
  EXPECT_FALSE(FindUnit("").has_value());
}

}  // namespace
}  // namespace simwright::physics_params
