// Images as written by cameras, printers and web tools: CMYK, 16 bits per channel, animated. Each
// is written by the format's own library.
#include <gif_lib.h>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <webp/encode.h>
#include <webp/mux.h>
#include <cstdio>  // jpeglib.h wants FILE

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "core/image.h"

namespace simwright::core {
namespace {

constexpr int kSide = 24;

void ExpectColour(const Image& image, std::array<int, 3> rgb, int tolerance) {
  ASSERT_EQ(image.width, kSide);
  ASSERT_EQ(image.height, kSide);
  ASSERT_GE(image.channels, 3);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(image.At(kSide / 2, kSide / 2)[c], rgb[c], tolerance) << "channel " << c;
  }
}

// Adobe's variant: inverted, with its marker.
std::string CmykJpeg(std::array<int, 4> ink) {
  jpeg_compress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = jpeg.image_height = kSide;
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg.write_Adobe_marker = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row;
  for (int x = 0; x < kSide; ++x) {
    for (const int amount : ink) row.push_back(static_cast<JSAMPLE>(255 - amount));
  }
  JSAMPROW rows[] = {row.data()};
  for (int y = 0; y < kSide; ++y) jpeg_write_scanlines(&jpeg, rows, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const std::string text(reinterpret_cast<char*>(bytes), size);
  std::free(bytes);
  return text;
}

TEST(UnusualImage, CmykBecomesRgb) {
  // Half cyan alone: (1 - 0.5) red, full green and blue.
  ExpectColour(DecodeImage(CmykJpeg({128, 0, 0, 0}), "cmyk.jpg"), {127, 255, 255}, 4);
  ExpectColour(DecodeImage(CmykJpeg({0, 255, 255, 0}), "cmyk.jpg"), {255, 0, 0}, 4);
  ExpectColour(DecodeImage(CmykJpeg({0, 0, 0, 128}), "cmyk.jpg"), {127, 127, 127}, 4);
}

TEST(UnusualImage, SixteenBitsBecomeEight) {
  const cv::Mat deep(kSide, kSide, CV_16UC3, cv::Scalar(257 * 200, 257 * 100, 257 * 7));  // BGR
  std::vector<unsigned char> bytes;
  ASSERT_TRUE(cv::imencode(".png", deep, bytes));
  ExpectColour(DecodeImage({reinterpret_cast<char*>(bytes.data()), bytes.size()}, "deep.png"),
               {7, 100, 200}, 0);
}

int Collect(GifFileType* file, const GifByteType* bytes, int count) {
  static_cast<std::string*>(file->UserData)->append(reinterpret_cast<const char*>(bytes), count);
  return count;
}

TEST(UnusualImage, AnAnimatedGifGivesItsFirstFrame) {
  std::string bytes;
  int error = 0;
  GifFileType* gif = EGifOpen(&bytes, Collect, &error);
  ASSERT_NE(gif, nullptr);
  EGifSetGifVersion(gif, true);
  const std::array<GifColorType, 4> colours = {
      {{200, 30, 40}, {10, 220, 30}, {0, 0, 0}, {9, 9, 9}}};
  ColorMapObject* map = GifMakeMapObject(4, colours.data());
  ASSERT_EQ(EGifPutScreenDesc(gif, kSide, kSide, 2, 0, map), GIF_OK);
  for (const GifPixelType frame : {0, 1}) {
    ASSERT_EQ(EGifPutImageDesc(gif, 0, 0, kSide, kSide, false, nullptr), GIF_OK);
    std::vector<GifPixelType> row(kSide, frame);
    for (int y = 0; y < kSide; ++y) ASSERT_EQ(EGifPutLine(gif, row.data(), kSide), GIF_OK);
  }
  GifFreeMapObject(map);
  ASSERT_EQ(EGifCloseFile(gif, &error), GIF_OK);
  ExpectColour(DecodeImage(bytes, "moving.gif"), {200, 30, 40}, 0);
}

TEST(UnusualImage, AnAnimatedWebpGivesItsFirstFrame) {
  WebPAnimEncoderOptions options;
  ASSERT_TRUE(WebPAnimEncoderOptionsInit(&options));
  WebPAnimEncoder* encoder = WebPAnimEncoderNew(kSide, kSide, &options);
  WebPConfig config;
  ASSERT_TRUE(WebPConfigInit(&config));
  config.lossless = 1;
  for (int frame = 0; frame < 2; ++frame) {
    WebPPicture picture;
    ASSERT_TRUE(WebPPictureInit(&picture));
    picture.use_argb = 1;
    picture.width = picture.height = kSide;
    ASSERT_TRUE(WebPPictureAlloc(&picture));
    for (int i = 0; i < kSide * kSide; ++i) picture.argb[i] = frame == 0 ? 0xFF1E90C8 : 0xFF000000;
    ASSERT_TRUE(WebPAnimEncoderAdd(encoder, &picture, 100 * frame, &config));
    WebPPictureFree(&picture);
  }
  WebPAnimEncoderAdd(encoder, nullptr, 200, nullptr);
  WebPData data;
  WebPDataInit(&data);
  ASSERT_TRUE(WebPAnimEncoderAssemble(encoder, &data));
  const std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
  WebPDataClear(&data);
  WebPAnimEncoderDelete(encoder);
  ExpectColour(DecodeImage(bytes, "moving.webp"), {0x1E, 0x90, 0xC8}, 0);
}

// Known formats that cannot be read are named, with a remedy.
TEST(UnusualImages, UnreadFormatsAreNamed) {
  using namespace std::literals;
  const std::pair<std::string, const char*> cases[] = {
      {"\0\0\0\x18"s + "ftypheic\0\0\0\0mif1heic"s, "HEIC"},
      {"\0\0\0\x18"s + "ftypmif1\0\0\0\0"s, "HEIC"},
      {"\0\0\0\x1c"s + "ftypavif\0\0\0\0"s, "AVIF"},
      {"\xabKTX 20\xbb\r\n\x1a\n"s, "KTX2"},
      {"DDS |\0\0\0"s, "DDS"},
      {"8BPS\0\1"s, "Photoshop"},
      {"<?xml version=\"1.0\"?><svg xmlns=\"\">"s, "SVG"},
      {"version https://git-lfs.github.com/spec/v1\n"s, "Git LFS"},
      {"<!DOCTYPE html><html>"s, "web page"},
      {std::string(2000, '\0'), "zeros"}};
  for (const auto& [bytes, word] : cases) {
    try {
      DecodeImage(bytes, "photo.jpg");
      ADD_FAILURE() << word << " was read";
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(word), std::string::npos) << what;
      EXPECT_NE(what.find('('), std::string::npos) << what << " has no remedy";
    }
  }
}

}  // namespace
}  // namespace simwright::core
