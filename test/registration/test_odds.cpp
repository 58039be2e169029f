// SPDX-License-Identifier: BSD-3-Clause
#include "answer/odds.h"
#include "registration/registration_scene.h"
#include "test_data.h"
#include <fresco/core/require.h>
#include <fresco/registration/core/scan_registration.h>
#include <limits>
namespace fresco {
namespace {
/// Two equal rooms between which nothing decides, see test_hints.cpp.
const test::ScannedScene& twins()
{
  static const test::ScannedScene scene = test::scanTwinRooms(false, 20000);
  return scene;
}

ScanRegistrationResult registerTwins(double confidence, const std::vector<RegistrationHint>& hints = {},
                                     int threads = 0)
{
  static PairMemory memory;
  ScanSource source(twins().scans.size(), [](Index i) { return twins().scans[i]; });
  source.memory = &memory;
  ScanRegistrationOptions options;
  options.confidence = confidence;
  options.hints = hints;
  options.threads = threads;
  return registerScans(source, {}, options);
}

Index placedCount(const ScanRegistrationResult& result)
{
  return std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& pose) { return pose.has_value(); });
}

CandidatePlace placeWith(double agree, double contradict, double violation = 0.0)
{
  CandidatePlace place;
  place.agree = agree;
  place.contradict = contradict;
  place.violation = violation;
  place.overlap = 0.5;
  return place;
}

double oddsOf(const CandidatePlace& place, bool joined = false, double usual = 0.0)
{
  return registration::oddsOf({place}, joined, usual)[0];
}

TEST(Odds, RiseWithAgreementAndFallWithContradiction)
{
  for (const double contradict : {0.001, 0.01, 0.1})
    for (double agree = 0.25; agree < 3.0; agree *= 2.0) {
      const double p = oddsOf(placeWith(agree, contradict));
      EXPECT_GT(p, 0.0);
      EXPECT_GT(oddsOf(placeWith(2.0 * agree, contradict)), p);
      EXPECT_LT(oddsOf(placeWith(agree, 2.0 * contradict)), p);
      EXPECT_GT(oddsOf(placeWith(agree, 0.0), true), oddsOf(placeWith(agree, 0.0))) << "what the joining steps took";
      const double joined_falls = oddsOf(placeWith(agree, contradict), true) / oddsOf(placeWith(agree, 0.0), true);
      EXPECT_LT(joined_falls, p / oddsOf(placeWith(agree, 0.0))) << "it is refined: no small motion mends it";
      EXPECT_GT(oddsOf(placeWith(agree, contradict), false, 0.02), p) << "where all pairs contradict a little";
    }
}

TEST(Odds, OfPlacesThatExcludeEachOtherAddUpToLessThanOne)
{
  const CandidatePlace place = placeWith(2.0, 0.0);
  double before = oddsOf(place);
  for (Index count = 2; count < 6; ++count) {
    const std::vector<double> odds = registration::oddsOf(std::vector<CandidatePlace>(count, place), false, 0.0);
    EXPECT_LT(odds[0], before);
    EXPECT_LT(count * odds[0], 1.0);
    EXPECT_EQ(odds.front(), odds.back());
    before = odds[0];
  }
  EXPECT_LT(oddsOf(placeWith(1e6, 0.0), true), 1.0) << "no more is claimed than examples allow";
}

TEST(Odds, ConfidenceIsInRange)
{
  for (const double wrong : {-0.9, 0.1, 0.49, 1.0, 2.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(registerTwins(wrong), std::invalid_argument) << wrong;
}

TEST(Odds, EveryScanAndPlaceHasThem)
{
  const ScanRegistrationResult result = registerTwins(0.0);
  ASSERT_FALSE(result.candidates.empty());
  for (const auto* places : {&result.candidates, &result.links})
    for (const CandidatePlace& place : *places) {
      EXPECT_TRUE(place.probability > 0.0 && place.probability < 1.0) << place.probability;
      EXPECT_EQ(place.part.empty(), places == &result.candidates);
      EXPECT_NE(result.scans[place.scan].group == result.scans[place.beside].group, places == &result.candidates);
    }
  for (const CandidatePlace& link : result.links)
    for (const Index scan : link.part)
      EXPECT_LE(result.scans[scan].probability, link.probability);
}

TEST(Odds, MoreConfidenceNeverPlacesMore)
{
  const ScanRegistrationResult alone = registerTwins(0.0);
  Index before = twins().scans.size();
  for (const double confidence : {0.5, 0.7, 0.9, 0.97, 0.99, 0.9999}) {
    const ScanRegistrationResult result = registerTwins(confidence);
    EXPECT_LE(placedCount(result), before) << confidence;
    before = placedCount(result);
    for (std::size_t i = 0; i < result.scans.size(); ++i) {
      EXPECT_TRUE(!result.scans[i].placed || before == 1 ||
                  result.scans[i].probability >= std::min(confidence, registration::largestClaim()))
          << i;
      if (alone.scans[i].placed && !result.scans[i].placed) {
        EXPECT_EQ(result.scans[i].refusal.reason, RefusalReason::unsure) << i;
      }
    }
  }
}

TEST(Odds, WhatNothingReachesIsSaid)
{
  ScanRegistrationOptions options;
  const auto warnings = [&](double confidence) {
    options.confidence = confidence;
    return registrationWarnings({}, options);
  };
  EXPECT_TRUE(warnings(0.99).empty());
  ASSERT_EQ(warnings(0.9999).size(), 1u);
  EXPECT_EQ(warnings(0.9999)[0].rfind("confidence 0.9999: ", 0), 0u) << warnings(0.9999)[0];
  EXPECT_EQ(registrationJson(registerTwins(registration::largestClaim()), {}),
            registrationJson(registerTwins(0.9999), {}));
}

TEST(Odds, APersonCountsAsBefore)
{
  const ScanRegistrationResult alone = registerTwins(0.0);
  std::vector<RegistrationHint> hints;
  const Index n = twins().scans.size();
  for (Index i = 0; i < n; ++i)
    if (!alone.scans[i].placed) {
      RegistrationHint& hint = hints.emplace_back();
      hint.kind = HintKind::relative;
      hint.b = i;
      hint.T_a_b = (twins().truth[0].inverse() * twins().truth[i]).matrix();
      hint.source = concat("line ", i);
    }
  for (const double confidence : {0.0, 0.9999}) {
    const ScanRegistrationResult result = registerTwins(confidence, hints);
    for (const RegistrationHint& hint : hints)
      EXPECT_EQ(result.scans[hint.b].hint, hint.source) << confidence;
  }
}

TEST(Odds, WhatAPersonSaysIsNotLost)
{
  const test::ScannedScene scene = test::scanTwoRooms(20000);
  PairMemory memory;
  const auto place = [&](double confidence, const std::vector<RegistrationHint>& hints) {
    ScanSource source(scene.scans.size(), [&](Index i) { return scene.scans[i]; });
    source.memory = &memory;
    ScanRegistrationOptions options;
    options.confidence = confidence;
    options.hints = hints;
    return registerScans(source, {}, options);
  };
  const ScanRegistrationResult alone = place(0.0, {});
  ASSERT_LT(placedCount(place(0.9999, {})), placedCount(alone));
  std::vector<RegistrationHint> hints;
  for (const CandidatePlace& link : alone.links)
    if (link.group == 0) {
      RegistrationHint& hint = hints.emplace_back();
      hint.kind = HintKind::link;
      hint.a = link.scan;
      hint.b = link.beside;
    }
  EXPECT_EQ(placedCount(place(0.9999, hints)), placedCount(alone));
}

TEST(Odds, DoNotDependOnThreads)
{
  const ScanRegistrationResult one = registerTwins(0.9, {}, 1), four = registerTwins(0.9, {}, 4);
  EXPECT_EQ(registrationJson(one, {}), registrationJson(four, {}));
}
} // namespace
} // namespace fresco
