// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "hirosco/descriptor/testing.hpp"

/// What the links of a mode take of shared memory fits what their ends say (E0377). Octets are those of docs/interfaces: a queue has a
/// head of 128 and depth + 1 slots, a lent set a head of 384 and four places, another link 96 and its sample, each on lines of 64.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;

std::string file(const char* name) { return file_system()(data / name).value(); }

/// A descriptor of the example that says how much shared memory it takes.
std::string limited(const char* name, const char* kb) {
  const std::string text = file(name);
  const std::string resources = std::string{"<Resources shared_memory_kB=\""} + kb + "\"/>";
  return std::string{text}.insert(text.find("<Configuration"), resources);
}

std::string problems_of(const FileSource& source) {
  std::string all;
  for (const Diagnostic& problem : read_mission(data / "mission.xml", source).problems)
    all += problem.code + " " + problem.message + ": " + problem.hint + "\n";
  return all;
}

/// The example's mission, in whose mode the plate's samples are queued (33 octets: a slot is a line) and the flywheel's are not; these go by a
/// method that the mission may say.
std::string with_queue(const std::string& depth, const char* of_robot, const char* of_wheel,
                       const std::string& of_link_2 = "") {
  const std::string both = R"( methods="shared_memory udp")";
  const std::string robot =
      changed(R"(byte_order="native" kind="latest")", R"(kind="queued")", limited("coronagraph.xml", of_robot));
  const std::string wheel =
      changed(R"(name="PLATE_STATE")", R"(name="PLATE_STATE" kind="queued" depth=")" + depth + '"',
              limited("flywheel.xml", of_wheel));
  const std::string way = R"(to="CORONAGRAPH.FLYWHEEL_STATE")";
  const std::string set = R"(name="FLYWHEEL_STATE")";
  return problems_of(overlay({{"mission.xml", changed(way, way + of_link_2)},
                              {"coronagraph.xml", changed(set, set + both, robot)},
                              {"flywheel.xml", changed(set, set + both, wheel)}}));
}

TEST(SharedMemoryOfLinks, OfAModeFitsWhatEachEndSays) {
  // 128 + 1020 * 64 of the queue, 128 of the other link: 64 kB to the octet.
  EXPECT_EQ(with_queue("1019", "64", "64"), "");
  EXPECT_EQ(with_queue("1020", "65", "65"), "");
}

TEST(SharedMemoryOfLinks, BeyondThatIsToldOfEachEndWithSumAndLimit) {
  const std::string of_wheel =
      "E0377 in mode 'telepresence' the links of 'FLYWHEEL' take 65600 octets of shared memory: at most 65536, the "
      "shared memory that it says: shorter queues, smaller samples, or shared_memory_kB=\"65\" or more in "
      "<Resources>\n";
  const std::string of_robot = changed("FLYWHEEL", "CORONAGRAPH", of_wheel);
  EXPECT_EQ(with_queue("1020", "65", "64"), of_wheel);
  EXPECT_EQ(with_queue("1020", "64", "65"), of_robot);
  EXPECT_EQ(with_queue("1020", "64", "64"), of_robot + of_wheel);
}

TEST(SharedMemoryOfLinks, IsNoneOfThoseThatGoByDatagrams) {
  EXPECT_NE(with_queue("1021", "64", "64"), "");
  EXPECT_EQ(with_queue("1021", "64", "64", R"( method="udp")"), "") << "128 + 1022 * 64 of the queue alone";
  EXPECT_NE(with_queue("1022", "64", "64", R"( method="udp")"), "");
}

TEST(SharedMemoryOfLinks, IsToldAtTheModeThatBringsThemUp) {
  const auto source = overlay(
      {{"flywheel.xml", changed(R"(name="PLATE_STATE" from)", R"(name="PLATE_STATE" kind="queued" depth="4096" from)",
                                limited("flywheel.xml", "64"))},
       {"coronagraph.xml",
        changed(R"(byte_order="native" kind="latest")", R"(kind="queued")", file("coronagraph.xml"))}});
  const auto reading = read_mission(data / "mission.xml", source);
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "E0377");
  const std::string text = testing::good_mission();
  const std::string before = text.substr(0, text.find("<Mode name=\"telepresence\""));
  EXPECT_EQ(reading.problems[0].at.line, 1 + std::count(before.begin(), before.end(), '\n'));
  // Where it is not brought up nobody has its memory.
  const auto without = changed("<Establish link=\"1\"/>", "", text);
  const auto not_established = overlay({{"mission.xml", without},
                                        {"flywheel.xml", changed("name=\"PLATE_STATE\" kind=\"queued\"",
                                                                 "name=\"PLATE_STATE\" required=\"no\" kind=\"queued\"",
                                                                 source("flywheel.xml").value())},
                                        {"coronagraph.xml", source("coronagraph.xml").value()}});
  EXPECT_EQ(problems_of(not_established), "");
}

/// A camera whose images, of 1 MiB with 32 octets, two look at.
std::string with_images(const char* of_camera, const char* of_each) {
  const auto described = [](const char* name, const char* id, const char* kb, const std::string& service) {
    return std::string{"<Subsystem name=\""} + name + "\" id=\"" + id + "\"><Resources shared_memory_kB=\"" + kb +
           "\"/><Configuration name=\"ONE\" id=\"1\" sampling_us=\"100000\"><RealTimeLinkService>" + service +
           "</RealTimeLinkService></Configuration></Subsystem>";
  };
  const std::string fields =
      R"(<Field name="NUMBER" type="UINT8"/><Field name="AT" type="DOUBLE" count="3"/><Field name="PIXEL" type="UINT8" count="1048576"/>)";
  const std::string takes = "<Requires name=\"IMAGE\" kind=\"loaned\">" + fields + "</Requires>";
  std::string mission = testing::good_mission(), members, links, commission, establish;
  for (const std::string name : {"camera", "first", "second"}) {
    members += "<Subsystem executable=\"" + name + "\" descriptor=\"" + name + ".xml\"/>";
    std::string upper = name;
    for (char& letter : upper) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    commission += "<Commission subsystem=\"" + upper + "\" configuration=\"ONE\"/>";
  }
  links = R"(<Link id="3" from="CAMERA.IMAGE" to="FIRST.IMAGE"/><Link id="4" from="CAMERA.IMAGE" to="SECOND.IMAGE"/>)";
  establish = R"(<Establish link="3"/><Establish link="4"/>)";
  mission = changed("<SimulatedDevice", members + "<SimulatedDevice", mission);
  mission = changed("<Links>", "<Links>" + links, mission);
  mission = changed("<Establish", commission + establish + "<Establish", mission);
  return problems_of(
      overlay({{"mission.xml", mission},
               {"camera.xml", described("CAMERA", "41", of_camera,
                                        "<Provides name=\"IMAGE\" kind=\"loaned\">" + fields + "</Provides>")},
               {"first.xml", described("FIRST", "42", of_each, takes)},
               {"second.xml", described("SECOND", "43", of_each, takes)}}));
}

TEST(SharedMemoryOfLinks, OfASetThatIsLentIsOneForAllItsConsumers) {
  // 384 + 4 * 1048640 octets, a sample of 8 + 24 + 1048576 on lines of 64: some more than 4096 kB.
  EXPECT_EQ(with_images("4097", "4097"), "");
  const std::string told = with_images("4096", "4097");
  EXPECT_EQ(told.substr(0, told.find(':')),
            "E0377 in mode 'telepresence' the links of 'CAMERA' take 4194944 octets of shared memory");
  EXPECT_EQ(with_images("4097", "4096").find("E0377 in mode 'telepresence' the links of 'FIRST' take 4194944"), 0U);
}

}  // namespace
}  // namespace hirosco::descriptor
