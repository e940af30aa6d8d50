// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/rows.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <functional>
#include <set>

namespace hirosco::tools::doctor {
namespace {

/// A computer on which nothing is to mend.
System good() {
  System system;
  system.user = "ada";
  system.highest_priority = 91;
  system.priority_limit = 95;
  system.memory_limit = unlimited;
  system.processors = 4;
  system.cycle_processor = 3;
  system.realtime_us = 950'000;
  system.realtime_of_us = 1'000'000;
  system.governor = "performance";
  system.kernel = "6.12.1-rt";
  system.preemption = "PREEMPT_RT";
  system.realtime_kernel = true;
  system.clock_source = "tsc";
  system.resolution = 1ns;
  system.synchronised = true;
  system.timer_slack = 50us;
  system.late = {3us, 5us, 40us};
  system.places = {{.path = "/run/user/7", .why_not = {}, .free_octets = 1ULL << 30}};
  system.ground_link = {{.address = "127.0.0.1:10015", .why_not = {}, .flight = {}},
                        {.address = "127.0.0.1:10025", .why_not = {}, .flight = {}}};
  system.page = {.address = "127.0.0.1:8080", .why_not = {}, .flight = {}};
  system.mission = "lamp/mission.xml";
  system.station = system.page_built = true;
  system.builder = "make";
  system.version = "0.1.0 interface 12";
  system.development = "/d/libparts.a";
  system.development_version = system.version;
  system.libraries = {"libsqlite3.so.0.8.6"};
  system.python = "python3.11";
  system.world = {.wanted = true,
                  .package = "hirosco-world-tank",
                  .program = true,
                  .library = "/w/libphysics.so.4",
                  .digest = "ab",
                  .fetched = "ab",
                  .fetcher = "fetch it"};
  return system;
}

/// What the row of this name finds.
Finding found(const std::string& name, const System& system) {
  for (const Row& row : rows())
    if (name == row.name) return row.judge(system);
  ADD_FAILURE() << "no row " << name;
  return {};
}

Error refused(int number) { return {ErrorCode::SystemFailure, "refused", number}; }

TEST(Doctor, FindsNothingWhereNothingIsToMend) {
  for (const Row& row : rows()) {
    const Finding finding = row.judge(good());
    EXPECT_EQ(finding.verdict, Verdict::Ok) << row.name << ": " << finding.found;
    EXPECT_NE(finding.found, "") << row.name;
    EXPECT_EQ(finding.mends, "") << row.name;
    EXPECT_NE(std::string{row.good_for}, "");
  }
}

/// One thing wrong with a computer: the row that says so, how it judges, what it tells and what it gives to type.
struct Case {
  const char* row;
  std::function<void(System&)> wrong;
  Verdict verdict;
  const char* tells;
  const char* mends;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"real-time rights", [](System& system) { system.no_priority = refused(EPERM), system.priority_limit = 0; },
       Verdict::Missing, "SCHED_FIFO 91 is refused to ada: Operation not permitted",
       "echo 'ada - rtprio 95' | sudo tee -a /etc/security/limits.d/90-hirosco.conf"},
      {"real-time rights", [](System& system) { system.no_priority = refused(EPERM); }, Verdict::Missing,
       "its control group has no time for it", "cpu.rt_runtime_us"},
      {"locked memory",
       [](System& system) { system.no_locked_memory = refused(ENOMEM), system.memory_limit = 8U << 20U; },
       Verdict::Missing, "refused, limit 8192 KiB: Cannot allocate memory", "ada - memlock unlimited"},
      {"isolation",
       [](System& system) {
         system.open = {"whoever has a device by TCP reaches every port (Landlock before version 4)"};
       },
       Verdict::WorthKnowing, "reaches every port", "linux-image-amd64"},
      {"isolation", [](System& system) { system.open = {"files are open to all (no Landlock)"}; },
       Verdict::WorthKnowing, "files are open to all", "lsm=landlock"},
      {"isolation",
       [](System& system) {
         system.open = {"all are of one user: for users of their own the flight lacks CAP_SETUID, CAP_KILL"};
       },
       Verdict::WorthKnowing, "lacks CAP_SETUID, CAP_KILL", "sudo systemctl edit hirosco@NAME"},
      {"isolation",
       [](System& system) {
         system.open = {"everything is open: HIROSCO_SANDBOX is off"};
         system.isolation_required = true;
       },
       Verdict::Missing, "the mission requires all", "unset HIROSCO_SANDBOX"},
      {"processors", [](System& system) { system.processors = 1; }, Verdict::WorthKnowing, "one for cycles", "nproc"},
      {"processor quota", [](System& system) { system.quota = 0.5, system.group = "/sys/fs/cgroup/a/cpu.max"; },
       Verdict::Missing, "0.50 processors", "echo max | sudo tee /sys/fs/cgroup/a/cpu.max"},
      {"throttling", [](System& system) { system.realtime_us = 500'000; }, Verdict::Missing, "50 %",
       "sudo sysctl kernel.sched_rt_runtime_us=950000"},
      {"kernel", [](System& system) { system.realtime_kernel = false, system.preemption = "PREEMPT_DYNAMIC"; },
       Verdict::WorthKnowing, "6.12.1-rt, PREEMPT_DYNAMIC: no PREEMPT_RT", "sudo apt install linux-image-rt-amd64"},
      {"governor", [](System& system) { system.governor = "powersave"; }, Verdict::WorthKnowing, "powersave",
       "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"},
      {"clock", [](System& system) { system.resolution = 4ms; }, Verdict::Missing, "4000000 ns", "highres=off"},
      {"clock", [](System& system) { system.clock_source = "hpet"; }, Verdict::WorthKnowing, "hpet", "echo tsc"},
      {"calendar", [](System& system) { system.synchronised = false; }, Verdict::WorthKnowing, "time service",
       "timedatectl set-ntp true"},
      {"timer slack", [](System& system) { system.no_priority = refused(EPERM); }, Verdict::WorthKnowing,
       "50 us, by which", "rtprio 95"},
      {"wake-up", [](System& system) { system.late.back() = 2ms; }, Verdict::WorthKnowing, "2000 us at most",
       "bench/run"},
      {"wake-up", [](System& system) { system.late.clear(); }, Verdict::WorthKnowing, "not measured", ""},
      {"ground link", [](System& system) { system.ground_link[1].why_not = "somebody listens there"; },
       Verdict::Missing, "127.0.0.1:10025: somebody listens there", "hirosco run lamp/mission.xml --instance NAME"},
      {"ground link",
       [](System& system) { system.ground_link[0].why_not = "somebody", system.ground_link[0].flight = "LAMP"; },
       Verdict::WorthKnowing, "127.0.0.1:10015 is that of the flight LAMP", "--instance NAME"},
      {"page", [](System& system) { system.station = false; }, Verdict::WorthKnowing, "no program hirosco-ground",
       "sudo apt install hirosco-ground"},
      {"page", [](System& system) { system.page_built = false; }, Verdict::WorthKnowing, "no page", "npm"},
      {"folders", [](System& system) { system.places[0].why_not = "Permission denied"; }, Verdict::Missing,
       "/run/user/7: Permission denied", "sudo install -d -o ada /run/user/7"},
      {"folders", [](System& system) { system.places[0].free_octets = 1U << 20U; }, Verdict::Missing,
       "/run/user/7: 1 MiB free, 64 wanted", "du -xh"},
      {"programs", [](System& system) { system.not_ready = {"E0401 no program lamp", "E0401 no program switch"}; },
       Verdict::Missing, "E0401 no program lamp and 1 more", "hirosco check --fly lamp/mission.xml"},
      {"versions",
       [](System& system) {
         system.other_versions = {"lamp.so: it was built against hirosco 0.0.9 interface 11", "switch.so: likewise"};
       },
       Verdict::Missing, "lamp.so: it was built against hirosco 0.0.9 interface 11 and 1 more", "cmake --build build"},
      {"versions", [](System& system) { system.development_version = "0.1.0 interface 13"; }, Verdict::WorthKnowing,
       "/d/libparts.a is of another build, 0.1.0 interface 13", "apt install ./*hirosco*.deb"},
      {"versions",
       [](System& system) {
         system.development_version = "0.1.0 interface 13";
         system.other_versions = {"lamp.so: it was built against hirosco 0.1.0 interface 13"};
       },
       Verdict::Missing, "/d/libparts.a is of another build, 0.1.0 interface 13", "apt install ./*hirosco*.deb"},
      {"libraries", [](System& system) { system.no_libraries = {"lamp.so: libz.so.1: cannot open"}; }, Verdict::Missing,
       "lamp.so: libz.so.1: cannot open", "sudo apt install --fix-broken"},
      {"world", [](System& system) { system.world.program = false; }, Verdict::Missing, "no program",
       "sudo apt install hirosco-world-tank  # in sources: fetch it"},
      {"world", [](System& system) { system.world.package.clear(); }, Verdict::Missing, "no template says which",
       "--reinstall hirosco"},
      {"world", [](System& system) { system.world.library.clear(); }, Verdict::Missing, "fetched, not packaged",
       "fetch it"},
      {"world", [](System& system) { system.world.digest = "cd"; }, Verdict::Missing, "is not what was fetched",
       "sudo rm /w/libphysics.so.4; fetch it"},
      {"world", [](System& system) { system.world.fetched.clear(); }, Verdict::WorthKnowing, "its hash", "fetch it"},
      {"python", [](System& system) { system.python.clear(); }, Verdict::WorthKnowing, "no program python3",
       "sudo apt install python3"},
      {"build tools", [](System& system) { system.no_tools = {"c++", "make", "gtest"}; }, Verdict::WorthKnowing,
       "no c++, no make, no gtest", "sudo apt install g++ cmake make libgtest-dev"},
  };
  return all;
}

TEST(Doctor, SaysOfEachThingThatIsWrongWhatItIsAndWhatMendsIt) {
  for (const Case& one : cases()) {
    System system = good();
    one.wrong(system);
    const Finding finding = found(one.row, system);
    EXPECT_EQ(finding.verdict, one.verdict) << one.row << ": " << finding.found;
    EXPECT_NE(finding.found.find(one.tells), std::string::npos) << one.row << ": " << finding.found;
    EXPECT_NE(finding.mends.find(one.mends), std::string::npos) << one.row << ": " << finding.mends;
    EXPECT_EQ(finding.mends.find('\n'), std::string::npos) << one.row;
  }
}

TEST(Doctor, HasACaseForEachRowThatSaysWhatIsWrong) {
  std::set<std::string> wrong, names;
  for (const Case& one : cases()) wrong.insert(one.row);
  for (const Row& row : rows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " is there twice";
    EXPECT_TRUE(wrong.contains(row.name)) << row.name;
  }
}

TEST(Doctor, KnowsWithoutWhichAMissionFliesAllTheSame) {
  std::set<std::string> of_rights;
  for (const Row& row : rows())
    if (of_time(row)) of_rights.insert(row.name);
  EXPECT_EQ(of_rights, (std::set<std::string>{"locked memory", "real-time rights"}));
}

TEST(Doctor, TakesNinjaForMakeAndSaysHowItIsNamed) {
  System system = good();
  EXPECT_EQ(found("build tools", system).found, "compiler, cmake, make, gtest");
  system.builder = "ninja";
  EXPECT_EQ(found("build tools", system).verdict, Verdict::Ok);
  EXPECT_NE(found("build tools", system).found.find("cmake -G Ninja"), std::string::npos);
}

TEST(Doctor, MissesNoWorldInWhichNobodyIs) {
  System system = good();
  system.world = {};
  EXPECT_EQ(found("world", system).verdict, Verdict::Ok);
  system.world.program = true;
  EXPECT_EQ(found("world", system).verdict, Verdict::Ok);
}

TEST(Doctor, TakesAPageElsewhereForNoFault) {
  System system = good();
  system.page.why_not = "somebody listens there";
  EXPECT_EQ(found("page", system).verdict, Verdict::Ok);
}

}  // namespace
}  // namespace hirosco::tools::doctor
