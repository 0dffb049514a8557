// Policies as ONNX and TorchScript: other libraries read the files and act as the policy does.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/dnn.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "rl/onnx_file.h"
#include "rl/policy_torch_script.h"
#include "rl/protobuf_writer.h"

namespace simwright::rl {
namespace {
namespace fs = std::filesystem;

constexpr int kObservation = 13, kAction = 5, kBatch = 40;

Eigen::MatrixXf Random(int rows, int columns, double range, core::Rng& rng) {
  Eigen::MatrixXf values(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      values(i, j) = static_cast<float>(range * (2.0 * core::Uniform(rng) - 1.0));
    }
  }
  return values;
}

Policy RandomPolicy(Activation activation) {
  core::Rng rng(7);
  std::vector<Mlp::Layer> layers;
  int inputs = kObservation;
  for (const int outputs : {32, 24, kAction}) {
    layers.push_back({Random(inputs, outputs, 0.3, rng), Random(1, outputs, 0.2, rng)});
    inputs = outputs;
  }
  const Eigen::RowVectorXf mean = Random(1, kObservation, 0.5, rng);
  const Eigen::RowVectorXf factor = Random(1, kObservation, 1.0, rng).array().abs() + 0.5f;
  return Policy(ObservationScale(mean, factor), Mlp(layers, activation),
                Eigen::RowVectorXf::Constant(kAction, 0.1f));
}

// Includes values far outside the normal range, which the scale clips.
Rows RandomObservations() {
  core::Rng rng(11);
  Rows observations = Random(kBatch, kObservation, 1.5, rng);
  observations.topRows(2) *= 100.0f;
  return observations;
}

const Metadata kMetadata = {{"task", "open_drawer"}, {"control_rate_hz", "20"}};

class PolicyExport : public testing::TestWithParam<Activation> {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  core::TemporaryFolder folder_;
};

TEST_P(PolicyExport, OpenCvActsAsThePolicyFromTheOnnxFile) {
  const Policy policy = RandomPolicy(GetParam());
  WriteOnnx(policy, kMetadata, Path("policy.onnx"));
  cv::dnn::Net net = cv::dnn::readNetFromONNX(Path("policy.onnx"));
  Rows observations = RandomObservations(), expected;
  policy.Act(observations, &expected);
  for (int i = 0; i < kBatch; ++i) {
    net.setInput(cv::Mat(1, kObservation, CV_32F, observations.row(i).data()), "observation");
    const cv::Mat action = net.forward("action");
    ASSERT_EQ(static_cast<int>(action.total()), kAction);
    for (int a = 0; a < kAction; ++a) {
      EXPECT_NEAR(action.at<float>(0, a), expected(i, a), 1e-6) << i << " " << a;
    }
  }
}

// Python's torch reads the module, runs it on the observations and prints the actions and metadata.
TEST_P(PolicyExport, PythonsTorchActsAsThePolicyFromTheTorchScript) {
  if (std::system("/usr/bin/python3 -c 'import torch' 2>/dev/null") != 0) {
    GTEST_SKIP() << "python3-torch is not installed";
  }
  const Policy policy = RandomPolicy(GetParam());
  WriteTorchScript(policy, kMetadata, Path("policy.pt"));
  Rows observations = RandomObservations(), expected;
  observations(5, 2) = std::nanf("");
  policy.Act(observations, &expected);
  {
    std::ofstream raw(Path("observations.bin"), std::ios::binary);
    raw.write(reinterpret_cast<const char*>(observations.data()),
              static_cast<std::streamsize>(observations.size() * sizeof(float)));
  }
  core::WriteFile(Path("run.py"),
                  "import sys, json, torch, numpy\n"
                  "extra = {'metadata.json': ''}\n"
                  "m = torch.jit.load('" +
                      Path("policy.pt") +
                      "', _extra_files=extra)\n"
                      "x = numpy.fromfile('" +
                      Path("observations.bin") +
                      "', dtype='float32')\n"
                      "y = m(torch.from_numpy(x.reshape(-1, 13)))\n"
                      "y.detach().numpy().tofile('" +
                      Path("actions.bin") +
                      "')\n"
                      "assert json.loads(extra['metadata.json'])['task'] == 'open_drawer'\n");
  ASSERT_EQ(std::system(("/usr/bin/python3 " + Path("run.py")).c_str()), 0);
  const std::string bytes = core::ReadFile(Path("actions.bin"), 1 << 20);
  ASSERT_EQ(bytes.size(), expected.size() * sizeof(float));
  const auto* actions = reinterpret_cast<const float*>(bytes.data());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(actions[i], expected.data()[i], 1e-6) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Activations, PolicyExport,
                         testing::Values(Activation::kElu, Activation::kTanh));

// The examples of the encoding's documentation (protobuf.dev): 150 in field 1, "testing" in field
// 2, and the first as a message in field 3.
TEST(Protobuf, EncodesTheDocumentationsExamples) {
  ProtobufWriter integer, text, message;
  integer.Integer(1, 150);
  EXPECT_EQ(integer.bytes(), std::string("\x08\x96\x01"));
  text.Bytes(2, "testing");
  EXPECT_EQ(text.bytes(), std::string("\x12\x07testing"));
  message.Message(3, integer);
  EXPECT_EQ(message.bytes(), std::string("\x1a\x03\x08\x96\x01"));
}

TEST(PolicyExportErrors, AnUnwritableFolderIsNamed) {
  const Policy policy = RandomPolicy(Activation::kElu);
  EXPECT_THROW(WriteOnnx(policy, {}, "/nonexistent/folder/policy.onnx"), core::Error);
  EXPECT_THROW(WriteTorchScript(policy, {}, "/nonexistent/folder/policy.pt"), core::Error);
}

}  // namespace
}  // namespace simwright::rl
