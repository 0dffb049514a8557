#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "capture/capture_mat.h"

namespace simwright::capture {
namespace {

constexpr double kPointsPerMetre = 72.0 / 0.0254;

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4f", value);
  return text;
}

// The content of a PDF page, in the mat's frame.
class PageContent {
 public:
  explicit PageContent(const CaptureMat& mat) : mat_(mat) {}

  // Sets the colour of what follows, sRGB in [0, 1].
  void Color(const Eigen::Vector3d& rgb) {
    text_ += Number(rgb.x()) + " " + Number(rgb.y()) + " " + Number(rgb.z()) + " rg\n";
  }

  void Rectangle(const Eigen::AlignedBox2d& box) {
    const Eigen::Vector2d low = Points(box.min()), size = kPointsPerMetre * box.sizes();
    text_ += Number(low.x()) + " " + Number(low.y()) + " " + Number(size.x()) + " " +
             Number(size.y()) + " re f\n";
  }

  // `size`: of the letters, m. The text holds neither parentheses nor backslashes.
  void Text(const Eigen::Vector2d& at, double size, const std::string& words) {
    const Eigen::Vector2d low = Points(at);
    text_ += "BT /F1 " + Number(kPointsPerMetre * size) + " Tf " + Number(low.x()) + " " +
             Number(low.y()) + " Td (" + words + ") Tj ET\n";
  }

  const std::string& text() const { return text_; }

 private:
  Eigen::Vector2d Points(const Eigen::Vector2d& at) const {
    return kPointsPerMetre * (at + 0.5 * Eigen::Vector2d(mat_.width, mat_.height));
  }

  const CaptureMat& mat_;
  std::string text_;
};

// A ruler with a line every millimetre, longer ones every 5 and 10 mm.
void AddRuler(const CaptureMat& mat, PageContent* page) {
  constexpr double kLine = 0.00015;
  const Eigen::Vector2d from(-0.5 * mat.columns * mat.square, mat.ruler_y);
  page->Rectangle({from, from + Eigen::Vector2d(mat.ruler, kLine)});
  const int millimetres = static_cast<int>(std::lround(1000.0 * mat.ruler));
  for (int mm = 0; mm <= millimetres; ++mm) {
    const double height = mm % 10 == 0 ? 0.004 : mm % 5 == 0 ? 0.003 : 0.002;
    const Eigen::Vector2d at(from.x() + 0.001 * mm, from.y());
    page->Rectangle(
        {at - Eigen::Vector2d(0.5 * kLine, 0.0), at + Eigen::Vector2d(0.5 * kLine, height)});
  }
  page->Text(from + Eigen::Vector2d(0.0, -0.0045), 0.003,
             "This ruler is 100 mm long. If it is not, print again at 100 %, or state its length.");
  page->Text(from + Eigen::Vector2d(mat.ruler + 0.004, 0.0005), 0.003,
             "simwright mat, " + mat.name + ". Lay it flat, object in the middle.");
}

}  // namespace

std::string MatPdf(const CaptureMat& mat) {
  PageContent page(mat);
  page.Color(kMatLight);
  page.Rectangle(mat.Printed());
  page.Color(kMatDark);
  for (const Eigen::AlignedBox2d& box : DarkRectangles(mat)) page.Rectangle(box);
  page.Color(Eigen::Vector3d::Zero());
  AddRuler(mat, &page);
  const std::vector<std::string> objects = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + Number(kPointsPerMetre * mat.width) + " " +
          Number(kPointsPerMetre * mat.height) +
          "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
      "<< /Length " + std::to_string(page.text().size()) + " >>\nstream\n" + page.text() +
          "endstream",
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"};
  std::string pdf = "%PDF-1.4\n";
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    offsets.push_back(pdf.size());
    pdf += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
  }
  const std::size_t table = pdf.size();
  pdf += "xref\n0 " + std::to_string(objects.size() + 1) + "\n0000000000 65535 f \n";
  for (const std::size_t offset : offsets) {
    char entry[32];
    std::snprintf(entry, sizeof entry, "%010zu 00000 n \n", offset);
    pdf += entry;
  }
  return pdf + "trailer\n<< /Size " + std::to_string(objects.size() + 1) +
         " /Root 1 0 R >>\nstartxref\n" + std::to_string(table) + "\n%%EOF\n";
}

}  // namespace simwright::capture
