#include "texture/materials/print_design.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <opencv2/imgproc.hpp>

namespace simwright::texture {
namespace {

// The colours of a package, RGB.
struct PrintColors {
  cv::Scalar ground, field, accent, ink;
};

PrintColors DrawnColors(core::Rng* rng) {
  static const PrintColors kColors[] = {
      {{246, 240, 226}, {34, 82, 61}, {214, 163, 62}, {30, 40, 36}},
      {{250, 247, 240}, {178, 34, 40}, {245, 196, 66}, {40, 24, 22}},
      {{238, 243, 247}, {25, 67, 120}, {240, 130, 50}, {20, 30, 48}},
      {{252, 236, 200}, {196, 92, 40}, {90, 48, 28}, {52, 30, 20}},
      {{34, 36, 40}, {190, 160, 92}, {232, 224, 206}, {240, 236, 226}},
      {{244, 250, 238}, {96, 152, 62}, {236, 96, 74}, {36, 50, 28}},
      {{250, 240, 244}, {148, 44, 92}, {246, 176, 90}, {50, 20, 36}},
      {{255, 216, 70}, {28, 30, 34}, {214, 44, 44}, {28, 30, 34}},
      {{226, 240, 240}, {18, 120, 124}, {250, 214, 110}, {16, 48, 52}}};
  constexpr int kCount = static_cast<int>(sizeof(kColors) / sizeof(kColors[0]));
  return kColors[core::UniformIndex(*rng, kCount)];
}

// Writes a line of text centred at (x, y), at most `width` wide and `height` tall, pixels.
void WriteCentred(const std::string& text, double x, double y, double width, double height,
                  const cv::Scalar& color, int font, cv::Mat* picture) {
  if (text.empty()) return;
  int baseline = 0;
  const cv::Size unit = cv::getTextSize(text, font, 1.0, 1, &baseline);
  const double scale = std::min(width / std::max(1, unit.width), height / std::max(1, unit.height));
  const int thickness = std::max(1, static_cast<int>(std::lround(3.6 * scale)));
  const cv::Size size = cv::getTextSize(text, font, scale, thickness, &baseline);
  const cv::Point at(static_cast<int>(x - 0.5 * size.width),
                     static_cast<int>(y + 0.5 * size.height));
  cv::putText(*picture, text, at, font, scale, color, thickness, cv::LINE_AA);
}

void DrawBarCode(const cv::Rect& place, core::Rng* rng, cv::Mat* picture) {
  cv::rectangle(*picture, place, {250, 250, 250}, cv::FILLED);
  const int margin = std::max(2, place.width / 14);
  for (int x = place.x + margin; x < place.x + place.width - margin;) {
    const int width = 1 + static_cast<int>(core::UniformIndex(*rng, 3));
    cv::rectangle(*picture, {x, place.y + margin, width, place.height - 2 * margin}, {20, 20, 20},
                  cv::FILLED);
    x += width + 1 + static_cast<int>(core::UniformIndex(*rng, 3));
  }
}

void DrawSmallPrint(const cv::Rect& place, const cv::Scalar& color, core::Rng* rng,
                    cv::Mat* picture) {
  const int line = std::max(3, place.height / 9);
  for (int y = place.y; y + line / 2 < place.y + place.height; y += line) {
    for (int x = place.x; x < place.x + place.width;) {
      const int word = line / 2 + static_cast<int>(core::UniformIndex(*rng, 2 * line + 1));
      const int end = std::min(x + word, place.x + place.width);
      cv::rectangle(*picture, {x, y, end - x, std::max(1, line / 3)}, color, cv::FILLED);
      x = end + std::max(1, line / 3);
    }
  }
}

// A disc with rays, leaves or rings: what a brand puts in its middle.
void DrawEmblem(const cv::Point2d& at, double radius, const PrintColors& colors, core::Rng* rng,
                cv::Mat* picture) {
  const int kind = static_cast<int>(core::UniformIndex(*rng, 3));
  const auto point = [&](double angle, double r) {
    return cv::Point(static_cast<int>(std::lround(at.x + r * std::cos(angle))),
                     static_cast<int>(std::lround(at.y + r * std::sin(angle))));
  };
  const int count = 6 + static_cast<int>(core::UniformIndex(*rng, 7));
  if (kind == 0) {
    for (int k = 0; k < count; ++k) {
      const double a = 2.0 * M_PI * k / count, half = M_PI / count * 0.55;
      const std::vector<cv::Point> ray = {point(a - half, 0.62 * radius), point(a, radius),
                                          point(a + half, 0.62 * radius)};
      cv::fillConvexPoly(*picture, ray, colors.accent, cv::LINE_AA);
    }
  } else if (kind == 1) {
    for (int k = 0; k < count; ++k) {
      const double a = 360.0 * k / count;
      const cv::Point middle = point(a * M_PI / 180.0, 0.62 * radius);
      const int r = static_cast<int>(radius);
      cv::ellipse(*picture, middle, {38 * r / 100, 15 * r / 100}, a, 0, 360, colors.accent,
                  cv::FILLED, cv::LINE_AA);
    }
  } else {
    cv::circle(*picture, at, static_cast<int>(radius), colors.accent, cv::FILLED, cv::LINE_AA);
    cv::circle(*picture, at, static_cast<int>(0.82 * radius), colors.ground, cv::FILLED,
               cv::LINE_AA);
  }
  cv::circle(*picture, at, static_cast<int>(0.55 * radius), colors.field, cv::FILLED, cv::LINE_AA);
  cv::circle(*picture, at, static_cast<int>(0.36 * radius), colors.accent, cv::FILLED, cv::LINE_AA);
}

// The field of the second colour: a band, a wave from below, or a frame.
void DrawField(const PrintColors& colors, core::Rng* rng, cv::Mat* picture) {
  const int w = picture->cols, h = picture->rows;
  switch (core::UniformIndex(*rng, 3)) {
    case 0:
      cv::rectangle(*picture, {0, 0, w, static_cast<int>(0.58 * h)}, colors.field, cv::FILLED);
      cv::rectangle(*picture, {0, static_cast<int>(0.58 * h), w, std::max(2, h / 40)},
                    colors.accent, cv::FILLED);
      break;
    case 1: {
      std::vector<cv::Point> wave = {{w, h}, {0, h}};
      const double turn = core::Uniform(*rng, 0.0, 6.28);
      for (int k = 0; k <= 96; ++k) {
        const int x = k * w / 96;
        // A whole number of waves, so that the print closes around a can.
        const double y = 0.44 + 0.07 * std::sin(2.0 * M_PI * x / w + turn);
        wave.emplace_back(x, static_cast<int>(y * h));
      }
      cv::fillPoly(*picture, std::vector<std::vector<cv::Point>>{wave}, colors.field, cv::LINE_AA);
      break;
    }
    default:
      cv::rectangle(*picture, {0, 0, w, h / 9}, colors.field, cv::FILLED);
      cv::rectangle(*picture, {0, h - h / 6, w, h / 6}, colors.field, cv::FILLED);
      cv::rectangle(*picture, {0, h / 9, w, std::max(2, h / 50)}, colors.accent, cv::FILLED);
      cv::rectangle(*picture, {0, h - h / 6 - h / 50, w, std::max(2, h / 50)}, colors.accent,
                    cv::FILLED);
      break;
  }
}

bool ContinuesCharacter(unsigned char byte) {
  return (byte & 0xc0) == 0x80;
}

bool HasGlyph(unsigned char byte) {
  return byte >= 0x20 && byte <= 0x7e;
}

// Returns a text (UTF-8) with a question mark for each character that the font lacks.
std::string WithGlyphs(const std::string& text) {
  std::string drawn;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (!ContinuesCharacter(byte)) drawn += HasGlyph(byte) ? c : '?';
  }
  return drawn;
}

bool IsDark(const cv::Vec3b& color) {
  return 0.3 * color[0] + 0.6 * color[1] + 0.1 * color[2] < 120;
}

}  // namespace

int CharactersWithoutGlyph(const std::string& text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](unsigned char c) {
    return !ContinuesCharacter(c) && !HasGlyph(c);
  }));
}

core::Image DrawPrint(const PrintDesign& design, core::Rng* rng) {
  const int w = design.width, h = design.height;
  cv::Mat picture(h, w, CV_8UC3);
  const PrintColors colors = DrawnColors(rng);
  picture.setTo(colors.ground);
  DrawField(colors, rng, &picture);
  const double side = std::min(0.62 * w, 0.95 * h);
  const double emblem = 0.25 * side, middle = 0.5 * w;
  const double title_y = core::Uniform(*rng, 0.26, 0.32) * h;
  DrawEmblem({middle, 0.62 * h}, emblem, colors, rng, &picture);
  const cv::Vec3b under =
      picture.at<cv::Vec3b>(static_cast<int>(title_y), static_cast<int>(middle));
  const cv::Scalar light(250, 246, 236);
  const bool bold = core::Uniform(*rng) < 0.5;
  WriteCentred(WithGlyphs(design.title), middle, title_y, 0.86 * side, 0.17 * h,
               IsDark(under) ? light : colors.ink,
               bold ? cv::FONT_HERSHEY_DUPLEX : cv::FONT_HERSHEY_TRIPLEX, &picture);
  const cv::Vec3b below =
      picture.at<cv::Vec3b>(static_cast<int>(0.88 * h), static_cast<int>(middle));
  WriteCentred(WithGlyphs(design.subtitle), middle, 0.90 * h, 0.4 * side, 0.05 * h,
               IsDark(below) ? light : colors.ink, cv::FONT_HERSHEY_DUPLEX, &picture);
  if (w > 1.15 * h) {
    // The sides of the label: small print on one, the bar code on the other.
    const int column = static_cast<int>(0.5 * (w - 1.02 * side)) - w / 40;
    const cv::Vec3b ground = picture.at<cv::Vec3b>(static_cast<int>(0.45 * h), w / 40 + 2);
    if (column > 24) {
      DrawSmallPrint({w / 40, static_cast<int>(0.30 * h), column, static_cast<int>(0.42 * h)},
                     IsDark(ground) ? cv::Scalar(226, 222, 212) : colors.ink, rng, &picture);
      DrawBarCode(
          {w - w / 40 - column, static_cast<int>(0.56 * h), column, static_cast<int>(0.2 * h)}, rng,
          &picture);
    }
  }
  core::Image image(w, h, 3);
  for (int y = 0; y < h; ++y) {
    std::memcpy(image.At(0, y), picture.ptr(y), static_cast<std::size_t>(3) * w);
  }
  return image;
}

}  // namespace simwright::texture
