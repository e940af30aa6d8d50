// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/interpreter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "supervisor/platform/launch/program_image.hpp"
#include "supervisor/platform/launch/subsystem_sandbox.hpp"
#include "supervisor/platform/launch/testing/exit_code.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

/// A program that is no script begins so.
constexpr std::string_view elf = "\177ELF";

/// A folder with interpreters in `bin`, the first of PATH and the HOME, and a script that is called arm.py.
struct ScriptTest : ::testing::Test {
  TestFolder folder;
  std::map<std::string, std::optional<std::string>> before;
  fs::path script = at("scripts/arm.py");

  void SetUp() override {
    for (const char* variable : {"PATH", "HOME", "PYTHONPATH"}) {
      const char* const text = std::getenv(variable);
      before[variable] = text != nullptr ? std::optional<std::string>{text} : std::nullopt;
    }
    ::setenv("PATH", (at("bin").string() + ":/usr/bin:/bin").c_str(), 1);
    ::setenv("HOME", fs::canonical(folder.path()).c_str(), 1);
    ::unsetenv("PYTHONPATH");
    put("bin/python3.11", elf, fs::perms::owner_all);
    fs::create_symlink("python3.11", at("bin/python3"));
    put("scripts/arm.py", "", fs::perms::owner_all);
  }
  void TearDown() override {
    for (const auto& [variable, text] : before)
      text ? ::setenv(variable.c_str(), text->c_str(), 1) : ::unsetenv(variable.c_str());
  }
  [[nodiscard]] fs::path at(const char* name) const { return fs::canonical(folder.path()) / name; }
  void put(const char* name, std::string_view text, fs::perms perms = fs::perms::owner_read) const {
    fs::create_directories(at(name).parent_path());
    std::ofstream{at(name)} << text;
    fs::permissions(at(name), perms);
  }
  /// Of arm.py with this first line.
  [[nodiscard]] Interpreter of(const std::string& line) const {
    return interpreter_of("#!" + line + "\nimport os\n", script).value();
  }
};

TEST_F(ScriptTest, IsKnownByItsFirstLineAndAProgramIsNone) {
  EXPECT_TRUE(interpreter_of(fs::path{HIROSCO_SOURCE_DIR "/tools/check_layers.py"}));
  EXPECT_FALSE(interpreter_of(fs::path{"/proc/self/exe"}));
  EXPECT_FALSE(interpreter_of(fs::path{"/no/such/program"}));
  EXPECT_FALSE(interpreter_of(at("bin")));
  EXPECT_FALSE(interpreter_of("\177ELF#!", script));
  EXPECT_FALSE(interpreter_of("", script));
}

TEST_F(ScriptTest, ExecutesItsInterpreterAndHasTheLibrariesOfThat) {
  const std::string python = at("bin/python3").string();
  const Interpreter made = of(" " + python + " -u");
  EXPECT_THAT(made.executable, ElementsAre(python, at("lib").string(), at("lib64").string()));
  EXPECT_THAT(made.readable, Contains(at("pyvenv.cfg").string()));
  EXPECT_THAT(made.listable, IsEmpty()) << "no module stands beside it";
  EXPECT_EQ(made.open, "");
}

TEST_F(ScriptTest, IsReadAsFarAsTheKernelReadsItsFirstLine) {
  EXPECT_THAT(of(std::string(300, ' ') + at("bin/python3").string()).executable, IsEmpty());
}

TEST_F(ScriptTest, ExecutesEnvAndWhatThatFindsFirstInPath) {
  put("other/python3", elf);  // which nobody may execute
  ::setenv("PATH", (at("other").string() + "::" + at("bin").string()).c_str(), 1);
  const std::string python = at("bin/python3").string();
  for (const char* line : {"/usr/bin/env python3", "/usr/bin/env\tpython3  ", "/usr/bin/env -S python3 -u",
                           "/usr/bin/env -Spython3 -u", "/usr/bin/env -S A=1 B=2 python3"}) {
    const Interpreter made = of(line);
    EXPECT_EQ(made.open, "") << line;
    ASSERT_GE(made.executable.size(), 2U) << line;
    EXPECT_EQ(made.executable[0], "/usr/bin/env");
    EXPECT_EQ(made.executable[1], python) << line;
  }
}

TEST_F(ScriptTest, OfAnEnvironmentOfItsOwnReadsWhatStandsThereAndWhatThatCameFrom) {
  put("venv/pyvenv.cfg", "home = elsewhere\n");
  fs::create_directories(at("venv/bin"));
  fs::create_symlink(at("bin/python3"), at("venv/bin/python"));
  const Interpreter made = of(at("venv/bin/python").string());
  for (const char* library : {"venv/lib", "lib"}) EXPECT_THAT(made.executable, Contains(at(library).string()));
  for (const char* file : {"venv/pyvenv.cfg", "pyvenv.cfg"}) EXPECT_THAT(made.readable, Contains(at(file).string()));
}

TEST_F(ScriptTest, ReadsFoldersThatAreCalledAsItsInterpreterAndThoseThatWhoeverFliesNames) {
  for (const char* module : {"share/python3/a", "share/pythonic/a", "share/perl/a", ".local/lib/python3.11/a"})
    put(module, "");
  put("share/python", "no folder");
  ::setenv("PYTHONPATH", "/opt/modules::/opt/more", 1);
  const Interpreter made = of("/usr/bin/env python3");
  for (const std::string& named : {at("share/python3").string(), at(".local/lib/python3.11").string(),
                                   std::string{"/opt/modules"}, std::string{"/opt/more"}})
    EXPECT_THAT(made.readable, Contains(named));
  for (const char* other : {"share/pythonic", "share/perl", "share/python", "share"})
    EXPECT_THAT(made.readable, Not(Contains(at(other).string()))) << other;
  put("bin/perl", elf, fs::perms::owner_all);
  EXPECT_THAT(of("/usr/bin/env perl").readable, Not(Contains("/opt/modules")));
}

TEST_F(ScriptTest, ReadsModulesBesideItAndNothingElseThatStandsThere) {
  for (const char* file : {"scripts/parts.py", "scripts/fast.so", "scripts/package/__init__.py", "scripts/keys.pem",
                           "scripts/data/arm.py", "scripts/__pycache__/parts.pyc"})
    put(file, "");
  const Interpreter made = of("/usr/bin/env python3");
  EXPECT_THAT(made.listable, ElementsAre(at("scripts").string()));
  for (const char* module : {"parts.py", "fast.so", "package", "__pycache__"})
    EXPECT_THAT(made.readable, Contains((at("scripts") / module).string()));
  for (const char* other : {"scripts/keys.pem", "scripts/data", "scripts"})
    EXPECT_THAT(made.readable, Not(Contains(at(other).string()))) << other;
  fs::create_symlink(script, at("bin/arm"));
  EXPECT_THAT(interpreter_of("#!/usr/bin/env python3\n", at("bin/arm"))->listable, ElementsAre(at("scripts").string()))
      << "where it really is";
}

TEST_F(ScriptTest, OfAnotherLanguageReadsBesideItWhatIsCalledLikeIt) {
  for (const char* file : {"scripts/hand.sh", "scripts/tool.sh", "scripts/parts.py"}) put(file, "");
  const auto made = interpreter_of("#!/bin/sh\n", at("scripts/hand.sh"));
  EXPECT_THAT(made->readable, Contains(at("scripts/tool.sh").string()));
  EXPECT_THAT(made->readable, Not(Contains(at("scripts/parts.py").string())));
  EXPECT_THAT(made->listable, IsEmpty()) << "it opens them by their names";
}

TEST_F(ScriptTest, ThatRunsFromMemoryHasNothingBesideIt) {
  const auto made = interpreter_of("#!/usr/bin/env python3\n", {});
  EXPECT_THAT(made->listable, IsEmpty());
  EXPECT_THAT(made->executable, Contains(at("bin/python3").string()));
  const auto image = ProgramImage::read(HIROSCO_SOURCE_DIR "/tools/check_layers.py");
  ASSERT_TRUE(image);
  EXPECT_THAT(image->interpreter()->executable, Contains(at("bin/python3").string()));
}

TEST_F(ScriptTest, WhoseInterpreterStartsOthersFliesInNoSandboxWhichIsSaid) {
  put("bin/shim", "#!/bin/sh\n", fs::perms::owner_all);
  EXPECT_EQ(of("/usr/bin/env shim").open, "its interpreter is a script, too");
  EXPECT_EQ(of(at("bin/shim").string()).open, "its interpreter is a script, too");
  for (const char* more :
       {"-i python3", "-S -u A python3", "-S PATH=/opt python3", "-S 'python3'", "-S --unset=B python3", ""})
    EXPECT_EQ(of(std::string{"/usr/bin/env "} + more).open, "its first line tells env more than is read here") << more;
}

TEST_F(ScriptTest, WhoseInterpreterIsNowhereGetsNothingForIt) {
  for (const char* line : {"/usr/bin/env no-such-interpreter", "", "  "})
    EXPECT_THAT(of(line).readable, IsEmpty()) << line;
  EXPECT_EQ(of("/no/such/interpreter").open, "");
}

TEST_F(ScriptTest, IsLetInBesideWhatItsSandboxHasAndHearsOfNoSignal) {
  Sandbox sandbox{.readable = {"/a"}, .executable = {"/b"}, .writable = {"/c"}};
  let_in({.executable = {"/x"}, .readable = {"/y"}, .listable = {"/z"}}, sandbox);
  EXPECT_THAT(sandbox.executable, ElementsAre("/b", "/x"));
  EXPECT_THAT(sandbox.readable, ElementsAre("/a", "/y"));
  EXPECT_THAT(sandbox.listable, ElementsAre("/z"));
  EXPECT_THAT(sandbox.writable, ElementsAre("/c"));
  EXPECT_EQ(sandbox.refusal, CallRefusal::Error);
}

/// The first in PATH that is no script; empty: there is none.
fs::path python_here() {
  std::string_view folders = std::getenv("PATH");
  while (!folders.empty()) {
    const auto colon = folders.find(':');
    const fs::path candidate = fs::path{folders.substr(0, colon)} / "python3";
    if (fs::exists(candidate) && !interpreter_of(candidate)) return candidate;
    folders = colon == std::string_view::npos ? std::string_view{} : folders.substr(colon + 1);
  }
  return {};
}

constexpr const char* tries_everything = R"(
import os, socket, sys, threading, xml.etree.ElementTree, json, mmap, struct
def refused(what, code):
    try:
        what()
    except PermissionError:
        return
    os._exit(code)
thread = threading.Thread(target=lambda: None)
thread.start()
thread.join()
refused(lambda: open(sys.argv[1]), 2)
refused(lambda: open("/etc/passwd"), 3)
refused(lambda: os.listdir("/"), 4)
refused(lambda: os.fork() or os._exit(5), 5)
refused(lambda: socket.socket(socket.AF_INET), 6)
refused(lambda: os.kill(os.getppid(), 0), 8)
refused(lambda: os.execv("/bin/sh", ["sh", "-c", "exit 9"]), 9)
refused(lambda: open("/tmp/made-by-a-script", "w"), 10)
)";

/// Apart (CMakeLists.txt), where the system has what a sandbox needs.
TEST(SubsystemInItsSandbox, IsAPythonScriptWithItsModulesTooAndReachesNothingElse) {
  const fs::path python = python_here();
  ASSERT_FALSE(python.empty());
  const TestFolder folder;
  const fs::path script = folder.path() / "arm.py", module = folder.path() / "parts.py", key = folder.path() / "key";
  std::ofstream{key} << "secret";
  std::ofstream{module} << "ANSWER = 7\n";
  for (const bool from_memory : {false, true}) {
    std::ofstream{script} << "#!" << python.string() << '\n'
                          << tries_everything
                          << (from_memory ? "sys.exit(11)\n" : "import parts\nsys.exit(parts.ANSWER)\n");
    fs::permissions(script, fs::perms::owner_all);
    descriptor::MissionSubsystem arm;
    arm.subsystem.file = "/missions/arm.xml";
    Sandbox sandbox = sandbox_of(arm, from_memory ? fs::path{} : script, {});
    const auto image = ProgramImage::read(script);
    ASSERT_TRUE(image);
    const auto interpreter = from_memory ? image->interpreter() : interpreter_of(script);
    ASSERT_TRUE(interpreter);
    ASSERT_EQ(interpreter->open, "");
    let_in(*interpreter, sandbox);
    const PreparedSandbox prepared{sandbox};
    ProcessStart start{.executable = script.string(), .arguments = {key.string()}};
    start.sandbox = &prepared;
    if (from_memory) {
      start.image = image->descriptor();
      start.inherited = {{image->descriptor(), 6}};
    }
    EXPECT_EQ(supervisor::testing::exit_code_of(start), from_memory ? 11 : 7);
  }
}

}  // namespace
}  // namespace hirosco::supervisor
