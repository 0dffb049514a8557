// Faults in a program are reported at their position, together with the correction.
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "reward/reward_program.h"
#include "tests/reward/sample_scene.h"

namespace simwright::reward {
namespace {

struct Case {
  const char* name;
  const char* source;
  const char* code;
  const char* place;
  const char* says;  // must be contained in the sentence
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

class RewardFindings : public testing::TestWithParam<Case> {};

TEST_P(RewardFindings, NameThePlaceAndTheThing) {
  const Case& one = GetParam();
  const RewardScene scene = SampleScene();
  const CompileOutcome outcome = CompileReward(one.source, &scene);
  ASSERT_FALSE(outcome.findings.empty()) << one.source;
  const core::Finding& finding = outcome.findings[0];
  EXPECT_EQ(finding.code, one.code) << finding.sentence;
  EXPECT_EQ(finding.place, one.place) << RenderFinding(finding, one.source);
  EXPECT_NE(finding.sentence.find(one.says), std::string::npos) << finding.sentence;
  const bool error = finding.severity == core::Severity::kError;
  EXPECT_EQ(outcome.program.has_value(), !error);
}

#define BODY "def compute_reward(env):\n"
#define GRIPPER BODY "    g = env.get_robot_gripper_pose()\n"
#define PARAMETERS "def compute_reward(x: torch.Tensor, v: torch.Tensor):\n"

const Case kSyntax[] = {
    {"While", BODY "    while True:\n        pass\n", "no-while", "2:5", "range"},
    {"Class", "class A:\n    pass\n", "no-class", "1:1", "functions"},
    {"Lambda", BODY "    f = lambda x: x\n    return f\n", "no-lambda", "2:9", "def"},
    {"Try", BODY "    try:\n        pass\n", "no-exceptions", "2:5", "try"},
    {"Global", BODY "    global x\n", "no-global", "2:5", "pass values"},
    {"Walrus", BODY "    if (x := 1):\n        pass\n", "no-walrus", "2:11", "':='"},
    {"Decorator", "@cached\n" BODY "    return 0\n", "bad-decorator", "1:1", "@cached"},
    {"BlockOnLine", BODY "    if 1: if 2: return 1\n", "syntax", "2:11", "simple statement"},
    {"Star", "def compute_reward(*args):\n    return 0\n", "syntax", "1:20", "'*'"},
    {"OpenBracket", BODY "    x = (1 + 2\n    return x\n", "open-bracket", "2:9", "'('"},
    {"CloseBracket", BODY "    x = 1)\n", "open-bracket", "2:10", "')'"},
    {"OpenString", BODY "    x = env.get_position(\"cup)\n", "open-string", "2:26", "quote"},
    {"Tabs", "def compute_reward(env):\n    x = 1\n\treturn x\n", "mixed-indentation", "3:1",
     "four spaces"},
    {"Dedent", BODY "        x = 1\n    return x\n", "bad-indentation", "3:5", "none of the"},
    {"Indent", BODY "    x = 1\n        return x\n", "bad-indentation", "3:9", "no block"},
    {"NotAscii", BODY "    r\xC3\xA9ward = 1\n", "not-ascii", "2:6", "look-alike"},
    {"CurlyQuote",
     BODY "    x = \xE2\x80\x9C"
          "cup\xE2\x80\x9D\n",
     "not-ascii", "2:9", "quote"},
    {"Number", BODY "    x = 12abc\n", "bad-number", "2:9", "no number"},
    {"HugeNumber", BODY "    x = 99999999999999999999\n", "bad-number", "2:9", "64 bits"},
    {"Character", BODY "    x = 1 ? 2\n", "bad-character", "2:11", "'?'"},
    {"MissingColon", "def compute_reward(env)\n    return 1\n", "syntax", "1:24", "':'"},
    {"Empty", "", "no-function", "1:1", "def compute_reward"},
    {"KeywordName", BODY "    if = 3\n", "syntax", "2:8", "expected a value"},
    {"Dunder", BODY "    return env.__class__\n", "forbidden", "2:16", "__class__"},
    {"DunderImport", BODY "    return __import__('os')\n", "forbidden", "2:12", "__import__"},
};

const Case kNames[] = {
    {"Eval", BODY "    return eval('1')\n", "forbidden", "2:12", "eval"},
    {"Exec", BODY "    exec('1')\n    return 1\n", "forbidden", "2:5", "exec"},
    {"Open", BODY "    return open('/etc/passwd')\n", "forbidden", "2:12", "open"},
    {"GetAttribute", BODY "    return getattr(env, 'sim')\n", "forbidden", "2:12", "getattr"},
    {"ImportOs", "import os\n" BODY "    return 1\n", "forbidden", "1:8", "'os'"},
    {"Undefined", GRIPPER "    return griper[:, 0]\n", "undefined", "3:12", "griper"},
    {"NearName", BODY "    gripper = env.get_robot_gripper_pose()\n    return griper[:, 0]\n",
     "undefined", "3:12", "'gripper'"},
    {"NearFunction", GRIPPER "    return torch.nrom(g, dim=-1)\n", "undefined", "3:18", "'norm'"},
    {"NearMethod", GRIPPER "    return g.summ(dim=-1)\n", "undefined", "3:14", "'sum'"},
    {"NearApi", BODY "    return env.get_robot_griper_pose()[:, 0]\n", "undefined", "2:16",
     "'get_robot_gripper_pose'"},
    {"Random", BODY "    return torch.rand(3)\n", "random", "2:18", "chance"},
    {"Asset", BODY "    return env.get_position('cop')[:, 0]\n", "unknown-asset", "2:29", "'cup'"},
    {"Link", BODY "    return env.get_pose_by_link_name('microwave', 'handle')[:, 0]\n",
     "unknown-link", "2:51", "'handle_0'"},
    {"Joint", BODY "    return env.get_joint_state('microwave', 'joint')\n", "unknown-joint",
     "2:45", "'joint_0'"},
    {"Continuous", BODY "    return env.get_joint_upper_limit('microwave', 'knob')\n", "no-limit",
     "2:51", "knob"},
    {"LimitKey", BODY "    return env.get_joint_limits('microwave', 'joint_0')['uper']\n",
     "bad-key", "2:56", "'upper'"},
    {"AssetType", BODY "    return env.get_position(3)[:, 0]\n", "arguments", "2:29", "string"},
    {"ApiArguments", BODY "    return env.get_position()\n", "arguments", "2:16", "'asset'"},
    {"Helper", BODY "    return get_position('cup')[0]\n", "arguments", "2:12", "get_position(env"},
    {"ShadowModule", BODY "    torch = 1\n    return torch\n", "shadows", "2:5", "torch"},
    {"ShadowEnvironment", BODY "    env = 1\n    return env\n", "shadows", "2:5", "environment"},
    {"ShadowApi", "def get_position(env):\n    return 1\n" BODY "    return 1\n", "shadows", "1:5",
     "get_position"},
    {"AssignAttribute", BODY "    env.reward = 1\n    return 1\n", "bad-target", "2:9", "local"},
    {"UnknownImport", "from cleverness import trick\n" BODY "    return trick(env)\n", "undefined",
     "3:12", "trick"},
    {"Recursion", "def f(x):\n    return f(x)\n" BODY "    return f(1)\n", "recursion", "2:12",
     "itself"},
    {"BranchOnly", GRIPPER "    if g[:, 0] > 0:\n        r = g[:, 1]\n    return r\n", "undefined",
     "5:12", "'r' is set only"},
    {"OwnName", "x = 1\n" GRIPPER "    y = x\n    x = 2\n    return g[:, 0] + y\n", "undefined",
     "4:9", "before it is set"},
    {"EndedFunction",
     "def f(a):\n    b = a + 1\n    def g():\n        return b\n    return g\n" GRIPPER
     "    return g[:, 0] + f(1)()\n",
     "nested-function", "4:16", "has ended"},
    {"InnerRecursion", GRIPPER "    def f(x):\n        return f(x)\n    return f(g)\n", "recursion",
     "4:16", "itself"},
    {"Deleted", GRIPPER "    r = g[:, 0]\n    del r\n    return r\n", "undefined", "5:12",
     "deleted in line 4"},
    {"DeletedPart", GRIPPER "    del g[0]\n    return g[:, 0]\n", "bad-target", "3:10", "names"},
    {"FormatOfTensor", GRIPPER "    k = f'{g[:, 0]:.2f}'\n    return g[:, 0]\n", "bad-string",
     "3:9", "are known"},
    {"UnknownFormat", GRIPPER "    k = f'{1.5:.2q}'\n    return g[:, 0]\n", "bad-string", "3:9",
     ":.2f"},
    {"FormatInFormat", GRIPPER "    k = f'{1.5:{2}}'\n    return g[:, 0]\n", "bad-string", "3:9",
     "holds a '{'"},
    {"OldFormat", GRIPPER "    k = 'a%d' % 1\n    return g[:, 0]\n", "type", "3:15", "f-string"},
    {"StarTwice", GRIPPER "    *a, *b = [1, 2]\n    return g[:, 0]\n", "unpack", "3:9", "one name"},
    {"StarTooFew", GRIPPER "    a, b, *c = [1]\n    return g[:, 0]\n", "unpack", "3:5", "3 names"},
    {"HoldsItself", GRIPPER "    d = {}\n    d['a'] = (d,)\n    return g[:, 0]\n", "type", "4:6",
     "inside another"},
    {"AppendsItself", GRIPPER "    d = []\n    d.append((1, d))\n    return g[:, 0]\n", "type",
     "4:15", "inside another"},
    {"UpdatesItself", GRIPPER "    d = {}\n    d.update({'a': d})\n    return g[:, 0]\n", "type",
     "4:14", "inside another"},
    {"NotADict", GRIPPER "    d = {**g}\n    return g[:, 0]\n", "type", "3:12", "dictionary"},
    {"InstanceOf", GRIPPER "    a = isinstance(g, env)\n    return g[:, 0]\n", "arguments", "3:23",
     "torch.Tensor"},
    {"SortedTensors", GRIPPER "    a = sorted([g[:, 0], g[:, 1]])\n    return a[0]\n", "type",
     "3:16", "torch.sort"},
    {"DictKey", GRIPPER "    parts = {'reach': g[:, 0]}\n    return parts['raech']\n", "bad-key",
     "4:17", "'reach'"},
};

const Case kTensors[] = {
    {"OneLogicalAnd",
     GRIPPER "    s = torch.logical_and((g[:, 0] < 1) & (g[:, 1] < 1))\n    return g[:, 0], s\n",
     "arguments", "3:15", "'other' is missing"},
    {"Shape", GRIPPER "    return g * env.get_goal_pose()[:, 0]\n", "shape", "3:14", "unsqueeze"},
    {"Batches", GRIPPER "    return g[:, 0] - g[:, 1].unsqueeze(-1)\n", "two-batches", "3:20",
     "every environment against"},
    {"Dimension", GRIPPER "    return torch.norm(g, dim=2)\n", "dimension", "3:30",
     "no dimension 2"},
    {"Index", GRIPPER "    return g[:, 3]\n", "index", "3:13", "no element 3"},
    {"TooManyIndices", GRIPPER "    return g[:, 0, 1]\n", "index", "3:13", "[N]"},
    {"Keyword", GRIPPER "    return torch.norm(g, dims=-1)\n", "arguments", "3:31", "'dim'"},
    {"NumberToTorch", GRIPPER "    return g[:, 0] + torch.exp(0.5)\n", "type", "3:32",
     "torch.tensor"},
    {"MaxNumber", GRIPPER "    return torch.max(g[:, 0], 0.5)\n", "arguments", "3:31", "clamp"},
    {"MeanOfInts", GRIPPER "    return g[:, 0] + (g > 0).mean()\n", "type", "3:30", ".float()"},
    {"SubtractFlags", GRIPPER "    return (g[:, 0] > 0) - (g[:, 1] > 0)\n", "type", "3:26",
     "flags"},
    {"NegateFlag", GRIPPER "    return -(g[:, 0] > 0)\n", "type", "3:12", "'~'"},
    {"InvertFloat", GRIPPER "    return ~g[:, 0]\n", "type", "3:12", "brackets"},
    {"AndOfNumbers", GRIPPER "    s = g[:, 0] < 1 & g[:, 1] < 1\n    return g[:, 0], s\n", "type",
     "3:21", "brackets"},
    {"TensorOfTensors", GRIPPER "    return torch.tensor([g[:, 0], g[:, 1]]).sum(0)\n", "type",
     "3:25", "torch.stack"},
    {"MaskIndex", GRIPPER "    return g[g[:, 0] > 0]\n", "bad-reward", "3:13", "torch.where"},
    {"MaskOfNumbers", GRIPPER "    return g[:, 0] + g[g > 0].mean()\n", "index", "3:23",
     "single numbers"},
    {"MaskMeetsAll", GRIPPER "    return g[:, 0] + g[:, 1][g[:, 0] > 0]\n", "shape", "3:20",
     "M are the environments"},
    {"MaskMeetsMask", GRIPPER "    return g[:, 1][g[:, 0] > 0] + g[:, 1][g[:, 0] < 0]\n", "shape",
     "3:33", "[M] and [M]"},
    {"MaskFromOther",
     GRIPPER "    r = g[:, 1]\n    r[g[:, 0] > 0] = r[g[:, 0] < 0]\n    return r\n", "index", "4:6",
     "same mask"},
    {"MaskFromAll", GRIPPER "    r = g[:, 1] * 2\n    r[g[:, 0] > 0] += g[:, 2]\n    return r\n",
     "shape", "4:20", "torch.where"},
    {"MaskFirst", GRIPPER "    return g[:, 1] + g[g[:, 0] > 0][0, 1]\n", "index", "3:36", "reduce"},
    {"MaskView", GRIPPER "    return g[:, 1] + g[g[:, 0] > 0].view(-1).mean()\n", "shape", "3:37",
     "[M, 3]"},
    {"MaskCondition",
     GRIPPER "    if g[:, 1][g[:, 0] > 0] > 0:\n        return g[:, 1]\n    return g[:, 2]\n",
     "condition", "3:29", "one flag"},
    {"Nonzero", GRIPPER "    return g[:, 0] + (g[:, 1] > 0).nonzero()\n", "undefined", "3:36",
     "torch.where"},
    {"Quantile", GRIPPER "    return torch.quantile(g, 0.5, dim=-1)\n", "undefined", "3:18",
     "torch.sort"},
    {"SortedOver", GRIPPER "    return torch.sort(g[:, 0], dim=0).values\n", "shape", "3:36",
     "environments"},
    {"SortedPlaces", GRIPPER "    return torch.sort(g, dim=1).indices[:, 0].float()\n", "undefined",
     "3:40", ".values"},
    {"MethodInPlaceShape", GRIPPER "    g.unsqueeze_(1)\n    return g[:, 0]\n", "shape", "3:7",
     "in place"},
    {"MethodInPlaceType", GRIPPER "    f = g[:, 0] > 0\n    f.add_(0.5)\n    return g[:, 0]\n",
     "type", "4:7", "cannot hold"},
    {"OneHotClasses", GRIPPER "    return torch.nn.functional.one_hot(g.argmax(dim=-1))[:, 0]\n",
     "arguments", "3:32", "number of classes"},
    {"TensorStep", GRIPPER "    return g[:, ::-1][:, 0]\n", "index", "3:13", ".flip"},
    {"Condition", GRIPPER "    if g > 0:\n        return g[:, 0]\n    return g[:, 1]\n",
     "condition", "3:10", "all(dim=-1)"},
    {"LoopOverBatch",
     GRIPPER "    for i in range(env.num_envs):\n        pass\n    return g[:, 0]\n", "loop",
     "3:24", "all of them at once"},
    {"LoopOverRows", GRIPPER "    for row in g:\n        pass\n    return g[:, 0]\n", "loop",
     "3:16", "all of them at once"},
    {"NoBreak",
     GRIPPER
     "    for i in range(3):\n        if g[:, 0] > i:\n            break\n    return g[:, 0]\n",
     "condition", "4:20", "torch.where"},
    {"Einsum", GRIPPER "    return torch.einsum('bij,bi->b', g, g)\n", "einsum", "3:25", "'bij'"},
    {"Stack", GRIPPER "    return torch.stack([g, g[:, 0]]).sum(0)\n", "shape", "3:24", "equal"},
    {"Clamp", GRIPPER "    return torch.clamp(g[:, 0])\n", "arguments", "3:18", "min, max"},
    {"WhereOne", GRIPPER "    return torch.where(g[:, 0] > 0)\n", "arguments", "3:18",
     "where(condition"},
    {"Reshape", GRIPPER "    return g.reshape(-1, 2)\n", "shape", "3:14", "product"},
    {"InPlaceType", GRIPPER "    c = (g[:, 0] > 0).int()\n    c += 0.5\n    return c\n", "type",
     "4:7", "cannot hold"},
    {"DivideByZero", GRIPPER "    return g[:, 0] * (1 / 0)\n", "division-by-zero", "3:25", "zero"},
    {"StringArithmetic", GRIPPER "    return g[:, 0] + 'a'\n", "type", "3:20", "'a'"},
    {"Unpack", GRIPPER "    a, b, c = env.get_bounding_box('cup')\n    return g[:, 0]\n", "unpack",
     "3:5", "3 names"},
    {"Huge", BODY "    return torch.zeros(1000, 1000).sum() + torch.ones(env.num_envs)\n",
     "too-large", "2:18", "4096"},
    {"LongLoop", BODY "    x = 0\n    for i in range(10 ** 9):\n        x += i\n    return x\n",
     "too-many-steps", "3:14", "100000"},
};

const Case kReturns[] = {
    {"None", GRIPPER "    x = g[:, 0]\n", "no-return", "1:5", "return reward"},
    {"Three", GRIPPER "    return g[:, 0], g[:, 1] > 0, g[:, 2]\n", "bad-return", "3:12",
     "3 values"},
    {"Table", GRIPPER "    return g\n", "bad-reward", "3:12", "[N, 3]"},
    {"Column", GRIPPER "    return g[:, 0:1]\n", "bad-reward", "3:13", "squeeze"},
    {"Success", GRIPPER "    return g[:, 0], g > 0\n", "bad-success", "3:12", "all(dim=-1)"},
    {"String", GRIPPER "    return 'done'\n", "bad-reward", "3:12", "'done'"},
    {"SomePath", GRIPPER "    if g[:, 0] > 0:\n        return g[:, 0]\n", "no-return", "1:5",
     "some environments"},
    {"Constant", BODY "    return torch.zeros(env.num_envs)\n", "constant-reward", "2:18",
     "nothing"},
    {"Shared", GRIPPER "    return g.mean()\n", "shared-reward", "3:14", "dim=-1"},
    {"SelfDistance", GRIPPER "    h = env.get_robot_gripper_position()\n    return (g - h)[:, 0]\n",
     "self-distance", "4:15", "always zero"},
    {"NormOverAll", GRIPPER "    return -torch.norm(g) + g[:, 0]\n", "norm-over-environments",
     "3:19", "dim=-1"},
    {"ConstantSuccess", GRIPPER "    return g[:, 0], True\n", "constant-success", "3:12", "same"},
    {"FixedJoint", BODY "    return env.get_joint_state('cup', 'base_joint')\n", "fixed-joint",
     "2:39", "never moves"},
    {"Parameter", "def compute_reward(name: str):\n    return 1\n", "bad-parameter", "1:20",
     "'str'"},
    {"OuterReturn", "return 1\n" BODY "    return 1\n", "syntax", "1:1", "outside"},
};

std::string NameOf(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Syntax, RewardFindings, testing::ValuesIn(kSyntax), NameOf);
INSTANTIATE_TEST_SUITE_P(Names, RewardFindings, testing::ValuesIn(kNames), NameOf);
INSTANTIATE_TEST_SUITE_P(Tensors, RewardFindings, testing::ValuesIn(kTensors), NameOf);
INSTANTIATE_TEST_SUITE_P(Returns, RewardFindings, testing::ValuesIn(kReturns), NameOf);

std::string Repeat(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(RewardBounds, DeepAndLongProgramsFailWithOneFinding) {
  const std::string deep[] = {
      BODY "    return " + Repeat("(", 10000) + "1" + Repeat(")", 10000) + "\n",
      BODY "    return " + Repeat("-", 10000) + "1\n",
      BODY "    return " + Repeat("not ", 5000) + "1\n",
      BODY "    return 1" + Repeat(" + 1", 5000) + "\n",
      BODY "    return x" + Repeat(".a", 5000) + "\n",
      BODY "    return 1" + Repeat(" if 1 else 2", 2000) + "\n",
      BODY "    return f'" + Repeat("{", 4001) + "'\n",
      BODY + Repeat("    x = 1\n", 100000),
      BODY "    x = 1  # " + Repeat("long ", 250000) + "\n"};
  for (const std::string& source : deep) {
    const CompileOutcome outcome = CompileReward(source, nullptr);
    ASSERT_EQ(outcome.findings.size(), 1u) << source.substr(0, 60);
    EXPECT_FALSE(outcome.program.has_value());
    const std::string& code = outcome.findings[0].code;
    EXPECT_TRUE(code == "too-deep" || code == "too-long" || code == "bad-string") << code;
  }
}

TEST(RewardBounds, LongChainsOfBranchesDoNotOverflowTheStack) {
  std::string source = GRIPPER "    r = g[:, 0]\n    if r > 0:\n        r = r + 1\n";
  source += Repeat("    elif r > 1:\n        r = r * 2\n", 1000) + "    return r\n";
  const CompileOutcome outcome = CompileReward(source, nullptr);
  ASSERT_EQ(outcome.findings.size(), 1u);
  EXPECT_EQ(outcome.findings[0].code, "too-deep");
}

TEST(RewardBounds, GrowthIsBounded) {
  const std::string growing[] = {
      BODY "    s = 'a'\n    for i in range(60):\n        s = s + s\n    return 1\n",
      BODY "    l = [1]\n    for i in range(60):\n        l = l + l\n    return 1\n",
      BODY "    l = [1]\n    for i in range(60):\n        l = [l, l]\n    return torch.tensor(l)\n",
      GRIPPER
      "    t = (g,)\n    for i in range(60):\n        t = (t, t)\n    if g[:, 0] > 0:\n"
      "        t = (t, 1)\n    else:\n        t = (t, 2)\n    return t\n",
      GRIPPER "    for i in range(99999):\n        g = g * g + i\n    return g[:, 0]\n"};
  for (const std::string& source : growing) {
    const CompileOutcome outcome = CompileReward(source, nullptr);
    EXPECT_FALSE(outcome.program.has_value()) << source;
    EXPECT_FALSE(outcome.findings.empty()) << source;
  }
}

TEST(RewardFinding, AllMistakesOfAProgramAreReportedOnce) {
  const std::string source = GRIPPER
      "    a = torch.nrom(g)\n    b = a + 1\n    c = env.get_position('cop')\n"
      "    return b + c\n";
  const RewardScene scene = SampleScene();
  const CompileOutcome outcome = CompileReward(source, &scene);
  ASSERT_EQ(outcome.findings.size(), 2u);
  EXPECT_EQ(outcome.findings[0].place, "3:15");
  EXPECT_EQ(outcome.findings[1].place, "5:26");
}

TEST(RewardFinding, WarningsCrowdOutNoError) {
  RewardOptions options;
  options.max_findings = 1;
  const RewardScene scene = SampleScene();
  const std::string source =
      BODY "    x = env.get_joint_state('cup', 'base_joint')\n    return y\n";
  const CompileOutcome outcome = CompileReward(source, &scene, options);
  EXPECT_FALSE(outcome.program.has_value());
  EXPECT_EQ(outcome.findings.back().code, "undefined");
}

TEST(RewardProgram, RefusesWhatDoesNotFit) {
  const CompileOutcome outcome = CompileReward(GRIPPER "    return g[7, 0] + g[:, 1]\n", nullptr);
  ASSERT_TRUE(outcome.program.has_value());
  const RewardProgram& program = *outcome.program;
  RewardWorkspace workspace(program, 16);
  std::vector<float> rows(48), reward(16);
  for (int i = 0; i < 48; ++i) rows[i] = static_cast<float>(i);
  const std::vector<RewardBinding> bindings = {{rows.data()}};
  program.Run(bindings, 16, &workspace, reward.data(), nullptr);
  EXPECT_EQ(reward[2], 21.0f + 7.0f);
  EXPECT_THROW(program.Run(bindings, 5, &workspace, reward.data(), nullptr), core::Error);
  EXPECT_THROW(program.Run(bindings, 17, &workspace, reward.data(), nullptr), core::Error);
  EXPECT_THROW(program.Run({}, 16, &workspace, reward.data(), nullptr), core::Error);
  const CompileOutcome other = CompileReward(GRIPPER "    return g[:, 1]\n", nullptr);
  RewardWorkspace foreign(*other.program, 16);
  EXPECT_THROW(program.Run(bindings, 16, &foreign, reward.data(), nullptr), core::Error);
}

TEST(RewardFinding, IsRenderedWithACaret) {
  const std::string source = "def compute_reward(env):\n    return gripper\n";
  const CompileOutcome outcome = CompileReward(source, nullptr);
  ASSERT_EQ(outcome.findings.size(), 1u);
  const std::string text = RenderFinding(outcome.findings[0], source);
  EXPECT_NE(text.find("2:12: error: "), std::string::npos);
  EXPECT_NE(text.find("\n        return gripper\n               ^\n"), std::string::npos) << text;
}

TEST(RewardOptions, OutOfRangeIsRefused) {
  RewardOptions options;
  options.max_depth = 0;
  std::string error;
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_NE(error.find("max_depth"), std::string::npos);
  EXPECT_THROW(CompileReward("", nullptr, options), core::Error);
}

TEST(RewardFindings, AShownLineCannotReachIntoTheTerminal) {
  const std::string source =
      "def compute_reward(env):\n    x = 1 # \x1b[2J\xc2\x9b\n    return y\n";
  const core::Finding finding{"x", core::Severity::kError, "2:5", "a \x1b]0;name", 0.0};
  const std::string text = RenderFinding(finding, source);
  EXPECT_EQ(text, "2:5: error: a ?]0;name\n        x = 1 # ?[2J?\n        ^\n");
}

}  // namespace
}  // namespace simwright::reward
