#include "texture/materials/named_materials.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "texture/materials/noise.h"

namespace simwright::texture {
namespace {

struct MaterialRow {
  const char* name;
  Substance substance;
  float color[3], second[3];
  float roughness;
  float strength = 1.0f, wear = 0.0f, scale = 1.0f;
  SkinFigure figure = SkinFigure::kPlain;
};

using enum Substance;
constexpr SkinFigure kKnots = SkinFigure::kSpots, kSpecks = SkinFigure::kSpots;
using enum SkinFigure;

// Colours are those that the real things have in daylight, sRGB. Rows of one name are alternatives.
constexpr MaterialRow kRows[] = {
    // Woods: earlywood and latewood; strength: pores.
    {"oak", kWood, {.78f, .62f, .43f}, {.55f, .39f, .23f}, .55f, 1.0f},
    {"oak", kWood, {.70f, .53f, .35f}, {.46f, .31f, .18f}, .50f, 1.0f},
    {"walnut", kWood, {.47f, .33f, .23f}, {.25f, .16f, .10f}, .48f, .7f},
    {"beech", kWood, {.85f, .68f, .51f}, {.71f, .51f, .35f}, .52f, .25f, 0, .7f},
    {"pine", kWood, {.90f, .75f, .53f}, {.74f, .52f, .29f}, .58f, .05f, 0, 1.3f, kKnots},
    {"maple", kWood, {.91f, .80f, .63f}, {.79f, .64f, .46f}, .45f, .1f, 0, .7f},
    {"cherry", kWood, {.72f, .46f, .30f}, {.54f, .30f, .18f}, .45f, .25f, 0, .8f},
    {"mahogany", kWood, {.53f, .27f, .18f}, {.34f, .15f, .10f}, .42f, .7f, 0, 1.2f},
    {"birch", kWood, {.89f, .78f, .61f}, {.77f, .62f, .44f}, .55f, .1f, 0, .8f},
    {"ash", kWood, {.84f, .73f, .57f}, {.61f, .48f, .33f}, .55f, .9f, 0, 1.2f},
    {"teak", kWood, {.66f, .47f, .28f}, {.45f, .29f, .16f}, .55f, .6f},
    {"acacia", kWood, {.63f, .43f, .26f}, {.33f, .20f, .12f}, .48f, .5f, 0, 1.4f},
    {"ebony", kWood, {.20f, .16f, .14f}, {.10f, .08f, .07f}, .38f, .3f},
    {"bamboo", kBamboo, {.86f, .74f, .50f}, {.70f, .54f, .31f}, .50f},
    {"plywood", kWood, {.86f, .73f, .54f}, {.71f, .55f, .37f}, .60f, .1f, 0, 2.2f},
    // Ceramics: strength: how the glaze breaks at the rim; second: the colour there and of specks.
    {"porcelain", kGlaze, {.95f, .95f, .93f}, {.97f, .97f, .96f}, .12f, .4f},
    {"ceramic", kGlaze, {.93f, .92f, .88f}, {.97f, .96f, .93f}, .15f, .5f},
    {"ceramic", kGlaze, {.20f, .36f, .58f}, {.55f, .62f, .68f}, .15f},
    {"ceramic", kGlaze, {.30f, .48f, .38f}, {.66f, .66f, .52f}, .17f},
    {"ceramic", kGlaze, {.66f, .20f, .16f}, {.78f, .48f, .38f}, .15f},
    {"ceramic", kGlaze, {.83f, .73f, .56f}, {.62f, .45f, .28f}, .22f, 1, 0, 1, kSpecks},
    {"ceramic", kGlaze, {.42f, .45f, .48f}, {.64f, .62f, .58f}, .20f, 1, 0, 1, kSpecks},
    {"ceramic", kGlaze, {.16f, .17f, .20f}, {.42f, .34f, .26f}, .18f},
    {"stoneware", kGlaze, {.80f, .76f, .68f}, {.45f, .33f, .22f}, .35f, 1, 0, 1, kSpecks},
    {"stoneware", kGlaze, {.52f, .58f, .58f}, {.40f, .31f, .22f}, .32f, 1, 0, 1, kSpecks},
    {"enamel", kGlaze, {.94f, .94f, .92f}, {.16f, .18f, .25f}, .14f, 1},
    {"terracotta", kClay, {.73f, .41f, .28f}, {.85f, .68f, .57f}, .88f},
    {"earthenware", kClay, {.68f, .38f, .26f}, {.82f, .64f, .53f}, .86f},
    {"clay", kClay, {.64f, .33f, .24f}, {.78f, .60f, .50f}, .92f},
    {"plaster", kClay, {.92f, .90f, .86f}, {.97f, .96f, .94f}, .90f, .5f},
    {"glass", kGlass, {.80f, .89f, .88f}, {.45f, .66f, .60f}, .05f},
    {"dark glass", kGlass, {.07f, .08f, .09f}, {.03f, .03f, .04f}, .06f},
    {"brown glass", kGlass, {.36f, .19f, .08f}, {.20f, .09f, .04f}, .06f},
    {"green glass", kGlass, {.22f, .38f, .20f}, {.10f, .22f, .10f}, .06f},
    // Stones.
    {"granite", kStone, {.72f, .66f, .62f}, {.52f, .47f, .45f}, .35f},
    {"granite", kStone, {.34f, .34f, .36f}, {.20f, .20f, .22f}, .30f},
    {"stone", kStone, {.62f, .59f, .55f}, {.52f, .49f, .45f}, .75f},
    {"slate", kConcrete, {.28f, .30f, .33f}, {.18f, .19f, .21f}, .65f},
    {"marble", kMarble, {.93f, .92f, .90f}, {.50f, .50f, .52f}, .18f},
    {"marble", kMarble, {.12f, .13f, .13f}, {.80f, .78f, .72f}, .16f},
    {"concrete", kConcrete, {.63f, .62f, .60f}, {.45f, .44f, .42f}, .85f},
    // Metals; second: tarnish.
    {"steel", kBrushedMetal, {.74f, .74f, .74f}, {.40f, .27f, .18f}, .32f},
    {"stainless steel", kBrushedMetal, {.75f, .75f, .75f}, {.52f, .49f, .45f}, .28f},
    {"aluminium", kBrushedMetal, {.81f, .82f, .83f}, {.60f, .60f, .59f}, .38f, .7f},
    {"brass", kBrushedMetal, {.80f, .66f, .36f}, {.45f, .36f, .20f}, .28f},
    {"bronze", kCastMetal, {.50f, .37f, .22f}, {.28f, .40f, .33f}, .45f},
    {"copper", kBrushedMetal, {.80f, .51f, .38f}, {.40f, .25f, .18f}, .25f},
    {"gold", kPolishedMetal, {.90f, .73f, .38f}, {.70f, .50f, .24f}, .15f},
    {"rose gold", kPolishedMetal, {.86f, .62f, .53f}, {.62f, .42f, .35f}, .16f},
    {"silver", kPolishedMetal, {.86f, .85f, .83f}, {.36f, .33f, .30f}, .16f},
    {"chrome", kPolishedMetal, {.80f, .81f, .82f}, {.50f, .50f, .50f}, .07f},
    {"tin", kBrushedMetal, {.76f, .76f, .76f}, {.50f, .46f, .42f}, .35f, .6f},
    {"zinc", kCastMetal, {.62f, .64f, .66f}, {.78f, .79f, .80f}, .50f},
    {"iron", kCastMetal, {.25f, .25f, .26f}, {.42f, .24f, .14f}, .60f},
    {"cast iron", kCastMetal, {.16f, .16f, .17f}, {.38f, .21f, .12f}, .65f},
    {"painted metal", kPaint, {.24f, .36f, .50f}, {.55f, .53f, .50f}, .38f},
    {"painted metal", kPaint, {.60f, .16f, .13f}, {.55f, .53f, .50f}, .38f},
    {"painted metal", kPaint, {.25f, .27f, .28f}, {.60f, .58f, .55f}, .45f},
    {"painted metal", kPaint, {.90f, .89f, .86f}, {.45f, .42f, .39f}, .35f},
    {"appliance", kPaint, {.93f, .93f, .92f}, {.70f, .70f, .70f}, .30f},
    {"appliance", kPaint, {.14f, .14f, .15f}, {.60f, .60f, .60f}, .32f},
    {"appliance", kPaint, {.68f, .69f, .70f}, {.50f, .50f, .50f}, .32f},
    {"paint", kPaint, {.90f, .89f, .86f}, {.72f, .60f, .45f}, .50f},
    {"paint", kPaint, {.36f, .46f, .44f}, {.72f, .60f, .45f}, .50f},
    {"paint", kPaint, {.28f, .33f, .42f}, {.72f, .60f, .45f}, .50f},
    {"toy paint", kPaint, {.76f, .14f, .12f}, {.80f, .66f, .46f}, .30f},
    {"toy paint", kPaint, {.12f, .36f, .66f}, {.80f, .66f, .46f}, .30f},
    {"toy paint", kPaint, {.16f, .50f, .30f}, {.80f, .66f, .46f}, .30f},
    {"toy paint", kPaint, {.94f, .74f, .16f}, {.80f, .66f, .46f}, .30f},
    // Plastics and rubber.
    {"plastic", kPlastic, {.92f, .92f, .90f}, {.7f, .7f, .7f}, .42f},
    {"plastic", kPlastic, {.12f, .12f, .13f}, {.3f, .3f, .3f}, .48f},
    {"plastic", kPlastic, {.78f, .15f, .13f}, {.5f, .1f, .1f}, .40f},
    {"plastic", kPlastic, {.13f, .33f, .62f}, {.1f, .2f, .4f}, .40f},
    {"plastic", kPlastic, {.20f, .52f, .32f}, {.1f, .3f, .2f}, .40f},
    {"plastic", kPlastic, {.95f, .73f, .16f}, {.7f, .5f, .1f}, .40f},
    {"plastic", kPlastic, {.52f, .55f, .57f}, {.3f, .3f, .3f}, .45f},
    {"black plastic", kPlastic, {.10f, .10f, .11f}, {.2f, .2f, .2f}, .50f},
    {"electronics", kPlastic, {.11f, .11f, .12f}, {.2f, .2f, .2f}, .50f},
    {"electronics", kBrushedMetal, {.70f, .71f, .72f}, {.4f, .4f, .4f}, .42f, .35f},
    {"screen", kGlass, {.045f, .05f, .06f}, {.02f, .02f, .03f}, .05f},
    {"rubber", kRubber, {.15f, .15f, .16f}, {.25f, .25f, .25f}, .90f},
    {"rubber", kRubber, {.62f, .17f, .13f}, {.4f, .1f, .1f}, .80f},
    {"rubber", kRubber, {.16f, .30f, .52f}, {.1f, .2f, .4f}, .80f},
    {"basketball", kRubber, {.74f, .36f, .15f}, {.2f, .1f, .1f}, .75f, 1, 0, 1, kPores},
    {"silicone", kRubber, {.34f, .50f, .52f}, {.2f, .3f, .3f}, .65f},
    {"foam", kFelt, {.93f, .84f, .35f}, {.7f, .6f, .2f}, .95f, 1, 0, 1.6f},
    {"scourer", kFelt, {.18f, .40f, .22f}, {.1f, .2f, .1f}, .95f, 1, 0, 1.2f},
    {"wax", kWax, {.94f, .90f, .80f}, {.88f, .80f, .64f}, .45f, .5f},
    {"soap", kWax, {.93f, .91f, .86f}, {.86f, .81f, .74f}, .40f, .6f},
    {"soap", kWax, {.76f, .83f, .72f}, {.62f, .71f, .58f}, .40f, .8f},
    {"soap", kWax, {.90f, .76f, .76f}, {.80f, .62f, .64f}, .40f, .8f},
    {"butter", kWax, {.97f, .89f, .58f}, {.94f, .83f, .47f}, .45f, .4f},
    {"cheese", kWax, {.95f, .78f, .38f}, {.88f, .66f, .26f}, .48f, .6f},
    {"chocolate", kWax, {.29f, .17f, .11f}, {.22f, .12f, .08f}, .35f, .4f},
    // Fabrics, leather, paper.
    {"cotton", kFabric, {.90f, .88f, .84f}, {.7f, .7f, .7f}, .92f},
    {"cotton", kFabric, {.30f, .38f, .50f}, {.2f, .3f, .4f}, .92f},
    {"linen", kFabric, {.80f, .74f, .62f}, {.6f, .5f, .4f}, .92f, 1.3f, 0, 1.4f},
    {"canvas", kFabric, {.77f, .70f, .57f}, {.5f, .5f, .4f}, .93f, 1.2f, 0, 1.8f},
    {"denim", kFabric, {.24f, .33f, .47f}, {.6f, .6f, .6f}, .92f, 1.6f, 0, 1.1f},
    {"fabric", kFabric, {.62f, .60f, .57f}, {.4f, .4f, .4f}, .92f, 1, 0, 1.5f},
    {"fabric", kFabric, {.35f, .42f, .40f}, {.2f, .3f, .3f}, .92f, 1, 0, 1.5f},
    {"fabric", kFabric, {.55f, .30f, .24f}, {.4f, .2f, .2f}, .92f, 1, 0, 1.5f},
    {"wool", kFelt, {.70f, .66f, .60f}, {.5f, .5f, .4f}, .97f, 1, 0, 1.6f},
    {"felt", kFelt, {.45f, .48f, .42f}, {.3f, .3f, .3f}, .97f},
    {"tennis ball", kFelt, {.80f, .88f, .26f}, {.6f, .7f, .2f}, .97f, 1, 0, 1.3f},
    {"bristles", kFelt, {.78f, .68f, .50f}, {.5f, .4f, .3f}, .9f, 1, 0, .7f},
    {"velvet", kFelt, {.36f, .10f, .16f}, {.2f, .1f, .1f}, .85f, .6f, 0, .6f},
    {"leather", kLeather, {.45f, .27f, .16f}, {.2f, .1f, .1f}, .55f},
    {"leather", kLeather, {.16f, .14f, .13f}, {.1f, .1f, .1f}, .50f},
    {"leather", kLeather, {.66f, .46f, .28f}, {.3f, .2f, .1f}, .55f},
    {"baseball", kLeather, {.92f, .90f, .85f}, {.7f, .7f, .6f}, .60f, .5f},
    {"upholstery", kFabric, {.55f, .53f, .50f}, {.4f, .4f, .4f}, .94f, 1, 0, 2.2f},
    {"upholstery", kFabric, {.28f, .34f, .40f}, {.2f, .2f, .3f}, .94f, 1, 0, 2.2f},
    {"upholstery", kLeather, {.38f, .24f, .16f}, {.2f, .1f, .1f}, .50f, 1, 0, 1.5f},
    {"paper", kPaper, {.95f, .94f, .91f}, {.8f, .8f, .8f}, .85f},
    {"tissue", kPaper, {.96f, .96f, .95f}, {.9f, .9f, .9f}, .92f},
    {"cardboard", kCardboard, {.72f, .57f, .40f}, {.5f, .4f, .3f}, .88f},
    {"cork", kCork, {.80f, .63f, .43f}, {.52f, .35f, .20f}, .90f},
    {"print", kPrint, {.94f, .93f, .90f}, {.5f, .5f, .5f}, .40f},
    {"wicker", kFabric, {.70f, .54f, .34f}, {.5f, .4f, .2f}, .75f, 2.2f, 0, 7.0f},
    // Fruit, vegetables, bread.
    {"apple", kSkin, {.68f, .10f, .11f}, {.83f, .70f, .30f}, .35f, 1, 0, 1, kStreaks},
    {"apple", kSkin, {.78f, .22f, .13f}, {.88f, .74f, .30f}, .35f, 1, 0, 1, kStreaks},
    {"apple", kSkin, {.52f, .66f, .22f}, {.62f, .72f, .32f}, .35f, 1, 0, 1, kStreaks},
    {"orange", kSkin, {.95f, .52f, .08f}, {.86f, .40f, .04f}, .45f, 1, 0, 1, kPores},
    {"mandarin", kSkin, {.95f, .47f, .07f}, {.86f, .36f, .04f}, .42f, 1, 0, 1, kPores},
    {"grapefruit", kSkin, {.94f, .68f, .28f}, {.90f, .48f, .26f}, .45f, 1, 0, 1, kPores},
    {"lemon", kSkin, {.96f, .84f, .20f}, {.88f, .72f, .12f}, .42f, 1, 0, 1, kPores},
    {"lime", kSkin, {.42f, .60f, .16f}, {.32f, .48f, .12f}, .40f, 1, 0, 1, kPores},
    {"avocado", kSkin, {.17f, .20f, .11f}, {.24f, .30f, .14f}, .55f, 1.2f, 0, 1, kPores},
    {"strawberry", kSkin, {.80f, .10f, .10f}, {.90f, .70f, .30f}, .30f, .8f, 0, 1, kPores},
    {"banana", kSkin, {.94f, .80f, .25f}, {.48f, .46f, .18f}, .48f, .8f, 0, 1, kSpots},
    {"pear", kSkin, {.76f, .73f, .30f}, {.55f, .45f, .20f}, .45f, .7f, 0, 1, kSpots},
    {"mango", kSkin, {.88f, .62f, .22f}, {.72f, .25f, .16f}, .35f, .5f, 0, 1, kSpots},
    {"peach", kSkin, {.95f, .70f, .42f}, {.80f, .28f, .22f}, .80f, .0f, 0, 1, kFuzz},
    {"kiwi", kSkin, {.47f, .36f, .20f}, {.36f, .27f, .14f}, .90f, .2f, 0, 1, kFuzz},
    {"potato", kSkin, {.76f, .61f, .40f}, {.60f, .44f, .26f}, .75f, 1, 0, 1, kFuzz},
    {"coconut", kSkin, {.42f, .29f, .18f}, {.28f, .19f, .11f}, .95f, .4f, 0, 1, kFuzz},
    {"tomato", kSkin, {.82f, .15f, .09f}, {.88f, .36f, .16f}, .18f},
    {"plum", kSkin, {.27f, .12f, .25f}, {.42f, .22f, .34f}, .40f},
    {"cherry fruit", kSkin, {.50f, .04f, .09f}, {.36f, .02f, .06f}, .20f},
    {"egg", kSkin, {.90f, .77f, .64f}, {.84f, .66f, .52f}, .55f, .15f, 0, 1, kSpots},
    {"onion", kSkin, {.78f, .52f, .25f}, {.60f, .34f, .15f}, .40f, 1, 0, 1, kStreaks},
    {"pumpkin", kSkin, {.90f, .48f, .10f}, {.78f, .34f, .06f}, .45f, 1, 0, 1, kBands},
    {"watermelon", kSkin, {.20f, .36f, .14f}, {.48f, .62f, .32f}, .35f, 1, 0, 1, kBands},
    {"melon", kSkin, {.80f, .70f, .36f}, {.68f, .60f, .32f}, .55f, 1, 0, 1, kBands},
    {"cucumber", kSkin, {.20f, .40f, .14f}, {.38f, .55f, .24f}, .35f, 1, 0, 1, kBands},
    {"zucchini", kSkin, {.18f, .34f, .13f}, {.34f, .48f, .22f}, .35f, .7f, 0, 1, kBands},
    {"carrot", kSkin, {.92f, .48f, .12f}, {.76f, .36f, .08f}, .55f, .5f, 0, 1, kSpots},
    {"eggplant", kSkin, {.17f, .08f, .18f}, {.26f, .13f, .24f}, .18f},
    {"pepper", kSkin, {.78f, .11f, .08f}, {.60f, .08f, .06f}, .20f},
    {"pepper", kSkin, {.92f, .70f, .12f}, {.80f, .52f, .08f}, .20f},
    {"pomegranate", kSkin, {.68f, .16f, .18f}, {.84f, .48f, .30f}, .40f, .5f, 0, 1, kStreaks},
    {"fruit flesh", kSkin, {.82f, .40f, .20f}, {.88f, .66f, .28f}, .40f, .7f, 0, 1, kStreaks},
    {"vegetable", kSkin, {.36f, .52f, .22f}, {.56f, .66f, .36f}, .50f, .4f, 0, 1, kSpots},
    {"plant", kSkin, {.24f, .42f, .18f}, {.40f, .55f, .26f}, .55f, .5f, 0, 1, kStreaks},
    {"meat", kWax, {.66f, .26f, .22f}, {.88f, .74f, .68f}, .45f, 1.2f},
    {"bread", kCrust, {.86f, .66f, .40f}, {.55f, .30f, .13f}, .85f},
    {"crumb", kFelt, {.95f, .87f, .70f}, {.85f, .70f, .50f}, .95f, 1, 0, 1.5f},
    {"pastry", kCrust, {.92f, .74f, .46f}, {.68f, .40f, .16f}, .70f, .3f}};

struct ColorRow {
  const char* name;
  float color[3];
};

constexpr ColorRow kColors[] = {
    {"white", {.94f, .94f, .92f}},        {"ivory", {.95f, .92f, .83f}},
    {"cream", {.94f, .89f, .76f}},        {"beige", {.84f, .76f, .63f}},
    {"tan", {.76f, .62f, .45f}},          {"brown", {.40f, .26f, .16f}},
    {"black", {.08f, .08f, .09f}},        {"charcoal", {.20f, .21f, .22f}},
    {"grey", {.52f, .53f, .54f}},         {"gray", {.52f, .53f, .54f}},
    {"silver grey", {.72f, .73f, .74f}},  {"red", {.72f, .12f, .11f}},
    {"crimson", {.62f, .06f, .15f}},      {"maroon", {.40f, .08f, .10f}},
    {"burgundy", {.38f, .07f, .13f}},     {"scarlet", {.80f, .14f, .08f}},
    {"orange", {.93f, .48f, .12f}},       {"amber", {.88f, .58f, .14f}},
    {"yellow", {.95f, .80f, .18f}},       {"mustard", {.78f, .60f, .17f}},
    {"gold", {.83f, .66f, .30f}},         {"lime", {.63f, .78f, .20f}},
    {"green", {.18f, .48f, .25f}},        {"olive", {.44f, .45f, .22f}},
    {"sage", {.60f, .66f, .54f}},         {"mint", {.66f, .86f, .74f}},
    {"forest green", {.12f, .31f, .18f}}, {"emerald", {.06f, .50f, .36f}},
    {"teal", {.08f, .44f, .45f}},         {"turquoise", {.22f, .68f, .67f}},
    {"cyan", {.20f, .70f, .80f}},         {"sky blue", {.50f, .74f, .90f}},
    {"blue", {.14f, .32f, .64f}},         {"navy", {.09f, .14f, .32f}},
    {"navy blue", {.09f, .14f, .32f}},    {"cobalt", {.10f, .24f, .58f}},
    {"indigo", {.20f, .18f, .45f}},       {"purple", {.42f, .20f, .52f}},
    {"violet", {.48f, .28f, .62f}},       {"lavender", {.74f, .68f, .86f}},
    {"magenta", {.74f, .14f, .48f}},      {"pink", {.92f, .62f, .69f}},
    {"salmon", {.92f, .56f, .47f}},       {"coral", {.93f, .47f, .38f}},
    {"rose", {.83f, .50f, .54f}},         {"peach", {.96f, .78f, .62f}}};

Eigen::Vector3f ColorFrom(const float (&color)[3]) {
  return {color[0], color[1], color[2]};
}

// Things of these materials come in any colour.
bool ColorsVary(Substance substance) {
  return substance == kGlaze || substance == kPaint || substance == kPlastic ||
         substance == kFabric || substance == kFelt || substance == kRubber;
}

// Turns the colour's hue by an angle (rad) about the grey axis.
Eigen::Vector3f HueTurned(const Eigen::Vector3f& color, float angle) {
  const Eigen::Vector3f axis = Eigen::Vector3f::Constant(0.57735f);
  return std::cos(angle) * color + std::sin(angle) * axis.cross(color) +
         (1.0f - std::cos(angle)) * axis.dot(color) * axis;
}

std::vector<const MaterialRow*> RowsOf(std::string_view name) {
  std::vector<const MaterialRow*> rows;
  for (const MaterialRow& row : kRows) {
    if (row.name == name) rows.push_back(&row);
  }
  return rows;
}

}  // namespace

bool IsNamedMaterial(std::string_view name) {
  return !RowsOf(name).empty();
}

SurfaceMaterial NamedMaterial(std::string_view name, core::Rng* rng,
                              std::optional<std::uint64_t> turn) {
  const std::vector<const MaterialRow*> rows = RowsOf(name);
  if (rows.empty()) throw core::Error("is not in the list of materials", std::string(name));
  const auto drawn =
      static_cast<std::uint64_t>(core::UniformIndex(*rng, static_cast<std::int64_t>(rows.size())));
  const MaterialRow& row = *rows[turn.value_or(drawn) % rows.size()];
  SurfaceMaterial material;
  material.name = row.name;
  material.substance = row.substance;
  const float light = static_cast<float>(core::Uniform(*rng, 0.94, 1.06));
  const float warm = static_cast<float>(core::Uniform(*rng, -0.015, 0.015));
  const float turned =
      ColorsVary(row.substance) ? static_cast<float>(core::Uniform(*rng, -0.30, 0.30)) : 0.0f;
  const auto varied = [&](const Eigen::Vector3f& color) {
    return Eigen::Vector3f(light * HueTurned(color, turned) + Eigen::Vector3f(warm, 0.0f, -warm))
        .cwiseMax(0.0f)
        .cwiseMin(0.98f)
        .eval();
  };
  material.color = varied(ColorFrom(row.color));
  material.second = varied(ColorFrom(row.second));
  material.roughness = row.roughness * static_cast<float>(core::Uniform(*rng, 0.88, 1.12));
  material.strength = row.strength;
  material.wear = row.wear;
  material.scale = row.scale * static_cast<float>(core::Uniform(*rng, 0.85, 1.2));
  material.figure = row.figure;
  material.seed = static_cast<std::uint32_t>((*rng)() >> 40);
  return material;
}

std::vector<std::string> MaterialNames() {
  std::vector<std::string> names;
  for (const MaterialRow& row : kRows) names.emplace_back(row.name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::optional<Eigen::Vector3f> NamedColor(std::string_view name) {
  constexpr struct {
    std::string_view word;
    float to, share;  // the grey that is mixed in, and its share
  } kModifiers[] = {{"dark ", 0.0f, 0.42f},
                    {"deep ", 0.0f, 0.35f},
                    {"light ", 1.0f, 0.45f},
                    {"pale ", 1.0f, 0.60f},
                    {"bright ", 0.5f, 0.0f}};
  for (const ColorRow& row : kColors) {
    if (row.name == name) return ColorFrom(row.color);
  }
  for (const auto& modifier : kModifiers) {
    if (!name.starts_with(modifier.word)) continue;
    const auto plain = NamedColor(name.substr(modifier.word.size()));
    if (!plain) return std::nullopt;
    return Mix(*plain, Eigen::Vector3f::Constant(modifier.to), modifier.share);
  }
  return std::nullopt;
}

void SetColor(const Eigen::Vector3f& color, SurfaceMaterial* material) {
  const Eigen::Vector3f former = material->color;
  material->color = color;
  switch (material->substance) {
    case Substance::kPaint:
      break;  // what is below it stays
    case Substance::kGlaze:
      material->second = Mix(color, Eigen::Vector3f(0.86f, 0.80f, 0.70f), 0.45f);
      break;
    case Substance::kBrushedMetal:
    case Substance::kPolishedMetal:
    case Substance::kCastMetal:  // anodised or plated: the metal's light with the colour's hue
      material->color = Mix(former, color, 0.65f);
      break;
    case Substance::kWood:
    case Substance::kBamboo: {
      // Stained: the grain keeps its contrast.
      const float ratio = material->second.mean() / std::max(0.05f, former.mean());
      material->second = color * std::clamp(ratio, 0.35f, 0.85f);
      break;
    }
    default:
      material->second = 0.65f * color;
      break;
  }
}

}  // namespace simwright::texture
