// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/flights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "ground/model/json.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr OnboardTime take_off{std::chrono::seconds{2'145'916'900}};

/// One lamp, which cycles at 100 Hz as the supervisor does.
[[nodiscard]] descriptor::Mission mission_of_a_lamp() {
  const descriptor::FileSource source = [](const std::filesystem::path& file) -> Result<std::string> {
    if (file.filename() == "mission.xml")
      return R"(<Mission name="NIGHT"><Supervisor descriptor="supervisor.xml"/>
<Subsystem executable="lamp" descriptor="lamp.xml"/><Modes initial="dark" start="dark"><Mode name="dark">
<Permit subsystem="*" functions="SET_STATE CONFIGURE SET_MODE SHUTDOWN"/></Mode></Modes></Mission>)";
    if (file.filename() == "lamp.xml")
      return R"(<Subsystem name="LAMP" id="11"><Configuration name="ON" id="1" priority="80" sampling_us="10000"/></Subsystem>)";
    return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / "supervisor" / file.filename());
  };
  auto reading = descriptor::read_mission("mission.xml", source);
  for (const auto& problem : reading.problems) ADD_FAILURE() << descriptor::render(problem, source, false);
  return reading.value.value_or(descriptor::Mission{});
}

/// A station that hears the supervisor's report of everybody, each second.
class Listener {
 public:
  explicit Listener(Archive& archive) : archive_{archive}, flights{catalogue_, archive} {}

  /// How often another flight began from `from` on, with these cycles of supervisor and others (100 Hz each) at `from`.
  int listen(OnboardTime from, int for_s, std::uint32_t supervisor, std::uint32_t others) {
    int begun = 0;
    for (int i = 0; i < for_s; ++i) {
      const auto counted = static_cast<std::uint32_t>(100 * i);
      begun += hear(from + i * 1s, supervisor + counted, others + counted) ? 1 : 0;
    }
    return begun;
  }

 private:
  bool hear(OnboardTime t, std::uint32_t supervisor, std::uint32_t others) {
    const auto apid = catalogue_.supervisor_column("SUBSYSTEMS.APID");
    const auto report = std::ranges::find_if(catalogue_.reports(), [&](const Report& one) {
      return std::ranges::find(one.places, apid.value_or(0), &Place::column) != one.places.end();
    });
    std::vector<std::byte> data(report->octets);
    OctetWriter{data}.put(report->sid);
    const auto put = [&](const std::string& name, std::size_t row, auto value) {
      const auto column = catalogue_.find_column("SUPERVISOR.SUBSYSTEMS." + name + "[" + std::to_string(row) + "]");
      const auto place = std::ranges::find(report->places, column.value_or(0), &Place::column);
      OctetWriter{std::span{data}.subspan(place->offset)}.put(value);
    };
    for (std::size_t row = 0; row < catalogue_.subsystems().size(); ++row) {
      put("APID", row, catalogue_.subsystems()[row]->id);
      put("STATE", row, std::uint8_t{5});
      put("CONFIGURATION", row, catalogue_.subsystems()[row]->configurations.front().id);
      put("CYCLES", row, row == 0 ? supervisor : others);
    }
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    const auto written = pus::write_telemetry(buffer, {.apid = 1, .service = 3, .subtype = 25, .time = t}, data);
    const auto packet = pus::TelemetryView::parse(*written);
    archive_.add(StoredPacket{.t = t, .apid = 1, .service = 3, .subtype = 25, .sid = report->sid, .octets = {}},
                 *written);
    static_cast<void>(model_.take(*packet));
    return flights.hear(model_);
  }

  Catalogue catalogue_{mission_of_a_lamp()};
  Archive& archive_;
  Model model_{catalogue_};

 public:
  Flights flights;
};

class AnArchiveOfFlights : public ::testing::Test {
 protected:
  [[nodiscard]] std::size_t count(const Listener& station) const { return station.flights.list()["flights"].size(); }
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
};

TEST_F(AnArchiveOfFlights, HasOneForAFlightThatGoesOn) {
  Listener station{*archive};
  EXPECT_EQ(station.listen(take_off, 60, 500, 300), 1);
  EXPECT_EQ(count(station), 1U);
  const json flight = station.flights.list()["flights"][0];
  EXPECT_NEAR(flight["from"].get<double>(), 2'145'916'900.0 - 5.0 - 2.0, 1e-3) << "500 cycles and the way up before";
  EXPECT_EQ(flight["to"], 2'145'916'959);
}

TEST_F(AnArchiveOfFlights, TellsTheNextOneByCyclesThatBeginAnew) {
  Listener station{*archive};
  ASSERT_EQ(station.listen(take_off, 60, 500, 300), 1);
  EXPECT_EQ(station.listen(take_off + 100s, 60, 200, 100), 1);
  EXPECT_EQ(count(station), 2U);
  EXPECT_NEAR(json_time(station.flights.began()), 2'145'916'996.0, 1e-3);
}

TEST_F(AnArchiveOfFlights, TellsTheNextOneFromAStationThatComesLateToIt) {
  {
    Listener station{*archive};
    ASSERT_EQ(station.listen(take_off, 60, 500, 300), 1);
  }
  // It has flown longer than the one before: counting on would be less.
  Listener later{*archive};
  EXPECT_EQ(later.listen(take_off + 1000s, 5, 60'000, 60'000), 1);
  EXPECT_EQ(count(later), 2U);
}

TEST_F(AnArchiveOfFlights, KnowsAFlightAgainAfterTheStationWasAway) {
  {
    Listener station{*archive};
    ASSERT_EQ(station.listen(take_off, 60, 500, 300), 1);
  }
  Listener again{*archive};
  EXPECT_EQ(again.listen(take_off + 300s, 5, 500 + 30'000, 300 + 30'000), 0);
  EXPECT_EQ(count(again), 1U);
}

TEST_F(AnArchiveOfFlights, IsTheSameWhenOnlyTheSupervisorBeganAnew) {
  Listener station{*archive};
  ASSERT_EQ(station.listen(take_off, 60, 500, 300), 1);
  EXPECT_EQ(station.listen(take_off + 62s, 60, 10, 300 + 6'200), 0);
  EXPECT_EQ(count(station), 1U);
}

TEST_F(AnArchiveOfFlights, TellsTheNextOneByAClockThatWentBack) {
  Listener station{*archive};
  ASSERT_EQ(station.listen(take_off, 60, 500, 300), 1);
  EXPECT_EQ(station.listen(take_off - 1000s, 5, 700, 700), 1);
  EXPECT_EQ(count(station), 2U);
}

TEST_F(AnArchiveOfFlights, NamesThemAndCountsWhatWasInEach) {
  Listener station{*archive};
  ASSERT_EQ(station.listen(take_off, 10, 500, 300), 1);
  const auto event = [&](OnboardTime t, int severity) {
    archive->add(StoredEvent{
        .t = t, .apid = 1, .subsystem = "S", .id = 1, .name = "A", .severity = severity, .text = "", .values = "{}"});
  };
  event(take_off + 1s, 4);
  event(take_off + 2s, 3);
  event(take_off + 3s, 3);
  event(take_off + 4s, 2);
  ASSERT_EQ(station.listen(take_off + 100s, 5, 200, 100), 1);
  event(take_off + 101s, 4);
  EXPECT_EQ(station.flights.name({{"flight", 1}, {"name", "the wall"}}, "anna", take_off).value()["name"], "the wall");
  EXPECT_EQ(station.flights.name({{"flight", 3}, {"name", "x"}}, "anna", take_off).error().status, 404U);
  EXPECT_EQ(station.flights.name({{"flight", 1}, {"name", std::string(81, 'x')}}, "anna", take_off).error().status,
            400U);
  const json list = station.flights.list()["flights"];
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1]["name"], "the wall");
  EXPECT_EQ(list[1]["named_by"], "anna");
  EXPECT_EQ(list[1]["high"], 1);
  EXPECT_EQ(list[1]["medium"], 2);
  EXPECT_EQ(list[0]["high"], 1);
  EXPECT_EQ(list[0]["name"], "");
}

TEST_F(AnArchiveOfFlights, KeepsNotesOfEachWithWhoWroteThemAndTakesSoManyAndSoLongOnes) {
  {
    Listener station{*archive};
    ASSERT_EQ(station.listen(take_off, 10, 500, 300), 1);
    ASSERT_EQ(station.listen(take_off + 100s, 5, 200, 100), 1);
    const auto note = [&](json body, const char* who) { return station.flights.note(body, who, take_off + 7s); };
    EXPECT_EQ(note({{"flight", 1}, {"note", "tip <b>hot</b>"}}, "anna").value()["notes"].size(), 1U);
    EXPECT_EQ(note({{"flight", 1}, {"note", "cooled"}}, "ben").value()["notes"][1]["who"], "ben");
    EXPECT_EQ(note({{"flight", 3}, {"note", "x"}}, "anna").error().status, 404U);
    EXPECT_EQ(note({{"flight", "1"}, {"note", "x"}}, "anna").error().status, 404U) << "a number is wanted";
    EXPECT_EQ(note({{"flight", 1}}, "anna").error().status, 400U);
    EXPECT_EQ(note({{"flight", 1}, {"note", ""}}, "anna").error().status, 400U);
    EXPECT_EQ(note({{"flight", 1}, {"note", std::string(1001, 'x')}}, "anna").error().status, 400U);
    EXPECT_TRUE(note({{"flight", 2}, {"note", std::string(1000, 'x')}}, "anna"));
    for (int i = 0; i < 99; ++i) ASSERT_TRUE(note({{"flight", 2}, {"note", "again"}}, "anna")) << i;
    EXPECT_EQ(note({{"flight", 2}, {"note", "one more"}}, "anna").error().status, 409U);
  }
  Listener later{*archive};  // another station of the same archive
  const json list = later.flights.list()["flights"];
  ASSERT_EQ(list.size(), 2U);
  const json expected = json::array({{{"t", 2'145'916'907}, {"who", "anna"}, {"text", "tip <b>hot</b>"}},
                                     {{"t", 2'145'916'907}, {"who", "ben"}, {"text", "cooled"}}});
  EXPECT_EQ(list[1]["notes"], expected) << "oldest first, as they were written";
  EXPECT_EQ(list[0]["notes"].size(), 100U);
  EXPECT_EQ(list[1]["name"], "") << "a note is no name";
}

}  // namespace
}  // namespace hirosco::ground
