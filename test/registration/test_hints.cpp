// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include "test_data.h"
#include "thread_ranks.h"
#include <fresco/io/file.h>
#include <fresco/registration/core/scan_registration.h>
#include <nlohmann/json.hpp>
namespace fresco {
namespace {
using test::relativeError;
using test::ScannedScene;

const std::vector<std::string> names = {"scans/scan_00.pcd", "scans/scan_01.pcd", "scans/scan_02.pcd",
                                        "scans/scan_03.pcd", "scans/scan_04.pcd"};

/// Two equal rooms between which nothing decides: by themselves, not all scans are placed.
const ScannedScene& twins()
{
  static const ScannedScene scene = test::scanTwinRooms(false, 20000);
  return scene;
}

ScanRegistrationOptions optionsWith(const std::vector<RegistrationHint>& hints, int threads = 0)
{
  ScanRegistrationOptions options;
  options.names = names;
  options.hints = hints;
  options.threads = threads;
  return options;
}

ScanSource sourceOf(const ScannedScene& scene, PairMemory& memory)
{
  ScanSource source(scene.scans.size(), [&scene](Index i) { return scene.scans[i]; });
  source.memory = &memory;
  return source;
}

/// By what an earlier registration found of pairs.
ScanRegistrationResult registerTwins(const std::vector<RegistrationHint>& hints, int threads = 0)
{
  static PairMemory memory;
  return registerScans(sourceOf(twins(), memory), {}, optionsWith(hints, threads));
}

Index placedCount(const ScanRegistrationResult& result)
{
  return std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& pose) { return pose.has_value(); });
}

RegistrationHint hintOf(HintKind kind, Index a, Index b)
{
  RegistrationHint hint;
  hint.kind = kind;
  hint.a = a;
  hint.b = b;
  hint.source = concat("hints.txt: line ", a, b);
  return hint;
}

RegistrationHint trueRelative(const ScannedScene& scene, Index a, Index b)
{
  RegistrationHint hint = hintOf(HintKind::relative, a, b);
  hint.T_a_b = (scene.truth[a].inverse() * scene.truth[b]).matrix();
  return hint;
}

/// From each scan that is not placed to a placed one.
std::vector<RegistrationHint> missing(const ScanRegistrationResult& result)
{
  std::vector<RegistrationHint> hints;
  const Index n = result.scans.size();
  Index placed = 0;
  while (!result.scans[placed].placed)
    ++placed;
  for (Index i = 0; i < n; ++i)
    if (!result.scans[i].placed)
      hints.push_back(trueRelative(twins(), placed, i));
  return hints;
}

std::string everything(const ScanRegistrationResult& result, const std::vector<RegistrationHint>& hints)
{
  return registrationJson(result, optionsWith(hints)) + registrationPage(result, optionsWith(hints));
}

bool isSaid(const ScanRegistrationResult& result, const std::string& words)
{
  return std::any_of(result.hints.begin(), result.hints.end(),
                     [&](const std::string& line) { return line.find(words) != std::string::npos; });
}

TEST(Hints, TruePosesPlaceWhatWasApart)
{
  const ScanRegistrationResult alone = registerTwins({});
  ASSERT_LT(placedCount(alone), 5);
  const std::vector<RegistrationHint> hints = missing(alone);
  const ScanRegistrationResult result = registerTwins(hints);
  EXPECT_EQ(placedCount(result), 5);
  EXPECT_LT(relativeError(result.poses, twins()).translation, 0.02);
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    EXPECT_EQ(result.scans[i].hint.empty(), alone.scans[i].placed) << i;
    if (alone.poses[i]) {
      EXPECT_LT((*result.poses[i] - *alone.poses[i]).norm(), 0.02) << "the frame moves with " << i;
    }
  }
  EXPECT_EQ(result.hints.size(), hints.size());
}

TEST(Hints, RoughPosesAreRefined)
{
  std::vector<RegistrationHint> hints = missing(registerTwins({}));
  for (RegistrationHint& hint : hints)
    hint.T_a_b.col(3).head<3>() += Eigen::Vector3d(0.1, -0.1, 0.05);
  const ScanRegistrationResult result = registerTwins(hints);
  EXPECT_EQ(placedCount(result), 5);
  EXPECT_LT(relativeError(result.poses, twins()).translation, 0.02);
}

TEST(Hints, APlaceThatTheOutputListsIsTakenByItsLine)
{
  const ScanRegistrationResult alone = registerTwins({});
  Index tried = 0;
  for (const CandidatePlace& place : alone.candidates) {
    if (place.contradicted || !alone.poses[place.beside])
      continue;
    const std::string file = test::scratchFolder() + ".txt";
    writeFile(file, hintLine(place, optionsWith({})) + "\n");
    const ScanRegistrationResult result = registerTwins(readHints(file, names));
    ASSERT_TRUE(result.poses[place.scan] && result.poses[place.beside]);
    const Eigen::Matrix4d T = result.poses[place.beside]->inverse() * *result.poses[place.scan];
    EXPECT_LT((T - place.T_beside_scan).norm(), 0.2);
    EXPECT_NE(result.scans[place.scan].hint, "");
    ++tried;
  }
  EXPECT_GT(tried, 0);
}

TEST(Hints, NearTakesThePlaceThatIsThere)
{
  const ScanRegistrationResult alone = registerTwins({});
  for (const CandidatePlace& place : alone.candidates) {
    if (alone.scans[place.beside].group != 0)
      continue;
    RegistrationHint hint = hintOf(HintKind::near, place.scan, 0);
    hint.place = (place.T_larger_group * alone.scans[place.scan].T_group_scan).topRightCorner<3, 1>();
    hint.radius = 0.3;
    const ScanRegistrationResult result = registerTwins({hint});
    if (result.poses[place.scan])
      EXPECT_LT((result.poses[place.scan]->topRightCorner<3, 1>() - hint.place).norm(), 0.4);
    else
      EXPECT_TRUE(isSaid(result, "not followed"));
  }
}

TEST(Hints, NeighboursThatAreTakenApartLoseAPlaceAndItIsSaid)
{
  const ScannedScene scene = test::scanTwoRooms(20000);
  PairMemory memory;
  const ScanRegistrationResult alone = registerScans(sourceOf(scene, memory), {}, optionsWith({}));
  const std::vector<RegistrationHint> hints = {hintOf(HintKind::apart, 0, 1)};
  const ScanRegistrationResult result = registerScans(sourceOf(scene, memory), {}, optionsWith(hints));
  EXPECT_TRUE(memory.used);
  EXPECT_NE(result.poses[0].has_value(), result.poses[1].has_value());
  EXPECT_EQ(result.scans[result.poses[0] ? 1 : 0].refusal.reason, RefusalReason::apart);
  EXPECT_TRUE(isSaid(result, "taken apart"));
  EXPECT_LT(relativeError(result.poses, scene).translation, 0.01);
}

// A room from elsewhere, which looks like none of the others.
TEST(Hints, StrangersAreNotLinked)
{
  ScannedScene scene = test::scanTwoRooms(20000);
  test::Boxes elsewhere;
  test::addRoom(elsewhere, {0, 0, 0}, {7, 3, 3.2}, std::numeric_limits<double>::quiet_NaN());
  test::addFurniture(elsewhere, {0.5, 0.5, 0}, {6.5, 2.5, 0}, 6, 21);
  scene.scans[4] = test::scanBoxes(elsewhere, test::stationPose({2, 1.5, 1.5}, 0.4, 0), 20000, 0.004, 9);
  PairMemory memory;
  for (const HintKind kind : {HintKind::link, HintKind::relative}) { // relative: at the same place as scan 0
    const ScanRegistrationResult result =
        registerScans(sourceOf(scene, memory), {}, optionsWith({hintOf(kind, 0, 4), hintOf(HintKind::order, 0, 0)}));
    EXPECT_FALSE(result.poses[4].has_value());
    EXPECT_NE(result.scans[4].problem, "");
    EXPECT_TRUE(isSaid(result, "not followed"));
    EXPECT_EQ(placedCount(result), 4);
  }
}

TEST(Hints, AResumedRunComesToWhatARunFromScratchComesTo)
{
  PairMemory memory;
  const ScanRegistrationResult alone = registerScans(sourceOf(twins(), memory), {}, optionsWith({}));
  EXPECT_FALSE(memory.used);
  EXPECT_EQ(everything(registerScans(sourceOf(twins(), memory), {}, optionsWith({})), {}), everything(alone, {}));
  EXPECT_TRUE(memory.used);
  std::vector<RegistrationHint> hints = missing(alone);
  hints.back().kind = HintKind::link;
  hints.push_back(hintOf(HintKind::order, 0, 0));
  PairMemory fresh;
  const ScanRegistrationResult resumed = registerScans(sourceOf(twins(), memory), {}, optionsWith(hints));
  const ScanRegistrationResult scratch = registerScans(sourceOf(twins(), fresh), {}, optionsWith(hints));
  EXPECT_EQ(resumed.poses, scratch.poses);
  EXPECT_EQ(everything(resumed, hints), everything(scratch, hints));
}

TEST(Hints, NeitherThreadsNorRanksChangeTheResult)
{
  std::vector<RegistrationHint> hints = missing(registerTwins({}));
  hints[0].kind = HintKind::link;
  const std::string wanted = everything(registerTwins(hints, 1), hints);
  EXPECT_EQ(everything(registerTwins(hints, 4), hints), wanted);
  test::ThreadRanks::run(2, [&](Exchange& ranks) {
    PairMemory memory;
    ScanSource scans = sourceOf(twins(), memory);
    scans.ranks = &ranks;
    EXPECT_EQ(everything(registerScans(scans, {}, optionsWith(hints, 1)), hints), wanted);
  });
}

TEST(Hints, WhatIsOfOtherScansOrDamagedIsNotUsed)
{
  const ScannedScene scene = test::scanTwoRooms(5000);
  PairMemory memory;
  registerScans(sourceOf(scene, memory), {}, optionsWith({}));
  const std::string whole = memory.bytes;
  ScanRegistrationOptions other = optionsWith({});
  other.max_violation = 0.03f;
  registerScans(sourceOf(scene, memory), {}, other);
  EXPECT_FALSE(memory.used);
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string("\n\n\n"), std::string()}) {
    memory.bytes = damaged;
    registerScans(sourceOf(scene, memory), {}, optionsWith({}));
    EXPECT_FALSE(memory.used);
  }
  EXPECT_EQ(memory.bytes, whole); // as found anew
  registerScans(sourceOf(scene, memory), {}, optionsWith({}));
  EXPECT_TRUE(memory.used);
}

TEST(Hints, EachScanWithoutAPlaceHasAReason)
{
  const ScanRegistrationResult result = registerTwins({});
  for (const ScanResult& scan : result.scans) {
    EXPECT_EQ(scan.placed, scan.refusal.reason == RefusalReason::none);
    if (!scan.placed && scan.refusal.reason != RefusalReason::loose) {
      EXPECT_EQ(scan.problem, refusalText(scan.refusal, optionsWith({})));
    }
  }
  const auto json = nlohmann::json::parse(registrationJson(result, optionsWith({})));
  EXPECT_EQ(json["candidates"].size(), result.candidates.size());
  const std::string page = registrationPage(result, optionsWith({}));
  for (const CandidatePlace& place : result.candidates)
    EXPECT_NE(page.find(hintLine(place, optionsWith({}))), std::string::npos);
  EXPECT_EQ(page.find(" src="), std::string::npos); // readable without anything beside it
}

TEST(HintsFile, SaysAllThatThereIs)
{
  const std::string file = test::scratchFolder() + ".txt";
  writeFile(file,
            "# of a person\nlink scan_00 scan_01.pcd # they see each other\n\n"
            "relative scans/scan_01.pcd \"scan_02\" 1 2 3 0 0 0 1\n"
            "relative scan_01 scan_02 1 0 0 1 0 1 0 2 0 0 1 3\n"
            "near scan_03 1.5 -2 0.5\nnear scan_03 1.5 -2 7 0.5\nchoose scan_00 scan_04 2\napart scan_00 scan_04\n"
            "order\n");
  const std::vector<RegistrationHint> hints = readHints(file, names);
  ASSERT_EQ(hints.size(), 8u);
  EXPECT_EQ(hints[0].a, 0);
  EXPECT_EQ(hints[0].b, 1);
  EXPECT_EQ(hints[0].source, file + ": line 2");
  EXPECT_EQ(hints[1].T_a_b, hints[2].T_a_b);
  EXPECT_TRUE(hints[3].any_height);
  EXPECT_EQ(hints[4].place.z(), 7.0);
  EXPECT_EQ(hints[4].radius, 0.5);
  EXPECT_EQ(hints[5].number, 2);
}

TEST(HintsFile, AWrongLineIsNamed)
{
  const std::string file = test::scratchFolder() + ".txt";
  const std::pair<const char*, const char*> cases[] = {
      {"join scan_00 scan_01", "no hint is called join"},
      {"link scan_00", "wants link A B"},
      {"link scan_00 scan_1", "there are scan_01.pcd"},
      {"link scan_00 scan_00", "same scan twice"},
      {"link scan_00 scan_01 3", "wants link A B"},
      {"relative scan_00 scan_01 1 2 3", "wants relative A B"},
      {"relative scan_00 scan_01 1 2 3 0 0 0 2", "no unit quaternion"},
      {"relative scan_00 scan_01 2 0 0 1 0 1 0 2 0 0 1 3", "not a rigid transform"},
      {"near scan_00 1 2 x", "x is no number"},
      {"near scan_00 1 2 -1", "RADIUS"},
      {"choose scan_00 scan_01 0", "counts from 1"},
      {"order scan_00", "is no number"}};
  for (const auto& [line, reason] : cases) {
    writeFile(file, std::string("# first\n") + line + "\n");
    try {
      readHints(file, names);
      ADD_FAILURE() << line;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind(file + ": line 2: ", 0), 0u) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }
}
} // namespace
} // namespace fresco
