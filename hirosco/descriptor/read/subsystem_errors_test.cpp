// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

using testing::marked;
using testing::read_text;
using testing::rendered;
using testing::text_source;

/// One mistake each; '@' marks the line and column that must be named.
struct Bad {
  const char* code;
  const char* body;
  const char* hint = nullptr;  ///< part of the hint, where it matters
};

/// `body` stands inside this subsystem, from its second line on.
std::string whole(const std::string& body) {
  return "<Subsystem name=\"S\" id=\"10\">\n" + body +
         "\n<StructRef name=\"CUR_VALUES\" id=\"0\" type=\"STRUCT\">"
         "<ParamRef name=\"STATE\" id=\"0\" type=\"INT32\"/><ParamRef name=\"POSITION\" id=\"0\" type=\"DOUBLE\" "
         "count=\"2\"/>"
         "</StructRef>\n<ParamRef name=\"GOAL\" id=\"1\" type=\"DOUBLE\" minimum=\"-1\" maximum=\"1\"/>\n"
         "<Device name=\"PLATE\"><Input><Field name=\"Q\" type=\"DOUBLE\"/></Input></Device>\n</Subsystem>";
}

// clang-format off
constexpr Bad bad_elements[] = {
    {"E0102", R"(@<Paramter name="X"/>)", "'Parameters'"},
    {"E0102", R"(<Parameters>@<Device name="X"/></Parameters>)"},
    {"E0106", R"(<StructRef name="A" id="1"><ParamRef name="X" id="9" type="INT8"/>@<StructRef name="B" id="2"/></StructRef>)"},
    {"E0102", R"(<TestService>@<Event/></TestService>)"},
    {"E0103", R"(<ParamRef name="X" id="2" type="DOUBLE" @units="m"/>)", "'unit'"},
    {"E0103", R"(<Parameters @name="X"/>)"},
    {"E0104", R"(<ParamRef name="X" id="2" type="@DUBLE"/>)", "'DOUBLE'"},
    {"E0104", R"(<ParamRef name="X" id="2" type="@STRUCT"/>)"},
    {"E0104", R"(<StructRef name="A" id="1" type="@DOUBLE"><ParamRef name="X" id="9" type="INT8"/></StructRef>)"},
    {"E0105", R"(@<ParamRef id="2" type="DOUBLE"/>)"},
    {"E0105", R"(@<ParamRef name="X" id="2"/>)"},
    {"E0105", R"(@<ParamRef name="X" type="DOUBLE"/>)"},
    {"E0105", R"(<EventService>@<Event name="X" id="3"/></EventService>)"},
    {"E0106", R"(@<StructRef name="A" id="1"/>)"},
    {"E0106", R"(@<Enumeration name="A"/><ParamRef name="X" id="2" type="INT8" enumeration="A"/>)"},
    {"E0106", R"(@<HKService id="1" interval="1"/>)"},
    {"E0106", R"(@<CustomService name="A" type="200"/>)"},
    {"E0102", R"(<Configuration name="C" id="1" sampling_us="100">@<CustomService name="A" type="200"/></Configuration>)"},
    {"E0106", R"(<HKService id="1" interval="1">@<SampledOnce/></HKService>)"},
    {"E0106", R"(@<Device name="X"/>)"},
    {"E0107", "<Parameters/>\n@<Parameters/>", "line 2"},
    {"E0107", "<Hang/>@<Hang/>"},
    {"E0108", "@text"},
    {"E0108", "<Parameters> \n  @x</Parameters>"},
    {"E0109", R"(<ParamRef name="X" id="2" type="DOUBLE" init="@ "/>)"},
    {"E0109", R"(<Enumeration name="A">@<Text value="1"> </Text></Enumeration><ParamRef name="X" id="2" type="INT8" enumeration="A"/>)"},
    {"E0110", R"(<ParamRef name="@A-B" id="2" type="DOUBLE"/>)"},
    {"E0110", R"(<ParamRef name="@" id="2" type="DOUBLE"/>)"},
    {"E0110", R"(<ParamRef name="@9A" id="2" type="DOUBLE"/>)"},
    {"E0110", R"(<FunctionService><Function name="@Move"/></FunctionService>)", "upper-case"},
    {"E0110", R"(<FunctionService><Function name="@ABCDEFGHIJKLMNOPQ"/></FunctionService>)"},
};
constexpr Bad bad_values[] = {
    {"E0111", R"(<ParamRef name="X" id="@one" type="DOUBLE"/>)"},
    {"E0111", R"(<ParamRef name="X" id="@1.5" type="DOUBLE"/>)"},
    {"E0111", R"(<ParamRef name="X" id="2" type="DOUBLE" init="@nan"/>)"},
    {"E0111", R"(<ParamRef name="X" id="2" type="DOUBLE" maximum="@inf"/>)"},
    {"E0111", R"(<ParamRef name="X" id="2" type="DOUBLE" init="@1e400"/>)"},
    {"E0111", R"(<ParamRef name="X" id="2" type="DOUBLE" init="@1,5"/>)"},
    {"E0111", R"(<ParamRef name="X" id="2" type="DOUBLE" count="2" init="@1 2x"/>)"},
    {"E0111", R"(<ParamRef name="X" id="@99999999999999999999" type="DOUBLE"/>)"},
    {"E0112", R"(<ParamRef name="X" id="@256" type="DOUBLE"/>)"},
    {"E0112", R"(<CustomService name="A" type="@191"><Request name="X" subtype="1"/></CustomService>)", "192 to 255"},
    {"E0112", R"(<CustomService name="A" type="200"><Request name="X" subtype="@0"/></CustomService>)", "1 to 255"},
    {"E0112", R"(<ParamRef name="X" id="@-1" type="DOUBLE"/>)"},
    {"E0112", R"(<ParamRef name="X" id="2" type="DOUBLE" count="@0"/>)"},
    {"E0112", R"(<EventService><Event name="X" id="@65536" severity="low"/></EventService>)"},
    {"E0112", R"(<HKService id="1" interval="@0"><SampledOnce><ParamRef name="GOAL"/></SampledOnce></HKService>)"},
    {"E0112", R"(<HKService id="1" interval="@4294967296"><SampledOnce><ParamRef name="GOAL"/></SampledOnce></HKService>)"},
    {"E0112", R"(<HKService id="1" interval="@-1"><SampledOnce><ParamRef name="GOAL"/></SampledOnce></HKService>)"},
    {"E0112", R"(<HKService id="1" interval="5"><SampledNREPTimes nrep="@0"><ParamRef name="GOAL"/></SampledNREPTimes></HKService>)"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="@0"/>)"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="100" power_W="@0"/>)"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="100" priority="@85"/>)", "0 to 84"},
    {"E0112", R"(<Configuration name="C" id="@0" sampling_us="100"/>)"},
    {"E0112", R"(<Hang realtime="@0"/>)"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE" watchdog_ms="@0"><Endnode transfer="unix" address="x"/></Device></Configuration>)"},
    {"E0113", R"(<ParamRef name="X" id="2" type="DOUBLE" protection="@true"/>)"},
    {"E0113", R"(<EventService><Event name="X" id="1" severity="@meduim"/></EventService>)", "'medium'"},
    {"E0113", R"(<FunctionService><Function name="X" states="@Operational SaveOperational"/></FunctionService>)", "'SafeOperational'"},
    {"E0113", R"(<FunctionService><Function name="X" states="@Operational Operational"/></FunctionService>)"},
    {"E0113", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="@usb" address="x"/></Device></Configuration>)", "one of"},
    {"E0114", R"(<ParamRef name="X" id="2" type="DOUBLE" unit="@123456789012345678901234567890123"/>)"},
    {"E0206", R"(<ParamRef name="X" id="2" type="DOUBLE" minimum="@2" maximum="1"/>)"},
    {"E0207", R"(<ParamRef name="X" id="2" type="DOUBLE" maximum="1" init="@2"/>)"},
    {"E0207", R"(@<ParamRef name="X" id="2" type="DOUBLE" minimum="1"/>)", "init"},
    {"E0207", R"(<FunctionService><Function name="X"><Argument name="A" type="DOUBLE" minimum="1" maximum="2" default="@0"/></Function></FunctionService>)"},
    {"E0207", R"(<Configuration name="C" id="1" sampling_us="100"><Set parameter="GOAL" value="@2"/></Configuration>)"},
    {"E0208", R"(<ParamRef name="X" id="2" type="UINT8" init="@1.5"/>)"},
    {"E0208", R"(<ParamRef name="X" id="2" type="UINT8" init="@256"/>)"},
    {"E0208", R"(<ParamRef name="X" id="2" type="INT64" init="@1e300"/>)"},
    {"E0208", R"(<ParamRef name="X" id="2" type="FLOAT" init="@1e39"/>)"},
    {"E0208", R"(<ParamRef name="X" id="2" type="INT8" minimum="@-129"/>)"},
    {"E0208", "<Enumeration name=\"A\"><Text value=\"1\">a</Text></Enumeration>\n<ParamRef name=\"X\" id=\"2\" type=\"DOUBLE\" enumeration=\"@A\"/>"},
    {"E0209", R"(<ParamRef name="X" id="2" type="DOUBLE" count="2" init="@1"/>)"},
    {"E0209", R"(<Device name="X" actuator="yes"><Output><Field name="Y" type="DOUBLE" safe="@0 0"/></Output></Device>)"},
    {"E0209", R"(<Configuration name="C" id="1" sampling_us="100"><Set parameter="CUR_VALUES" value="@1 2"/></Configuration>)"},
};
constexpr Bad bad_meaning[] = {
    {"E0201", "<CustomService name=\"A\" type=\"200\"><Request name=\"X\" subtype=\"1\"/></CustomService>\n@<CustomService name=\"A\" type=\"201\"><Request name=\"Y\" subtype=\"1\"/></CustomService>"},
    {"E0201", "<FunctionService><Function name=\"X\"/></FunctionService>\n<CustomService name=\"A\" type=\"200\">@<Request name=\"X\" subtype=\"1\"/></CustomService>"},
    {"E0202", "<CustomService name=\"A\" type=\"200\"><Request name=\"X\" subtype=\"1\"/></CustomService>\n@<CustomService name=\"B\" type=\"200\"><Request name=\"Y\" subtype=\"1\"/></CustomService>"},
    {"E0202", R"(<CustomService name="A" type="200"><Request name="X" subtype="1"/>@<Report name="Y" subtype="1"/></CustomService>)"},
    {"E0213", R"(<CustomService name="A" type="200"><Request name="@PING" subtype="1"/></CustomService>)"},
    {"E0215", R"(<CustomService name="A" type="200"><Request name="X" subtype="1"/>@<Report name="Y" subtype="2"><Field name="F" type="DOUBLE" count="600"/></Report></CustomService>)"},
    {"E0228", R"(<CustomService name="A" type="200"><Request name="X" subtype="1">@<Argument name="N" type="UINT8"/></Request></CustomService>)"},
    {"E0201", "<ParamRef name=\"X\" id=\"2\" type=\"INT8\"/>\n@<ParamRef name=\"X\" id=\"3\" type=\"INT8\"/>"},
    {"E0201", R"(<StructRef name="A" id="1"><ParamRef name="X" id="2" type="INT8"/>@<ParamRef name="X" id="3" type="INT8"/></StructRef>)"},
    {"E0201", "<FunctionService><Function name=\"A\"/></FunctionService>\n<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"><FunctionService>@<Function name=\"A\"/></FunctionService></Configuration>"},
    {"E0201", R"(<FunctionService><Function name="A"><Argument name="X" type="INT8" minimum="0" maximum="1"/>@<Argument name="X" type="INT8" minimum="0" maximum="1"/></Function></FunctionService>)"},
    {"E0201", R"(<EventService><Event name="A" id="1" severity="low"/>@<Event name="A" id="2" severity="low"/></EventService>)"},
    {"E0201", "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"/>\n@<Configuration name=\"C\" id=\"2\" sampling_us=\"100\"/>"},
    {"E0201", "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"><RealTimeLinkService><Provides name=\"P\"><ParamRef name=\"GOAL\"/><ParamRef name=\"@GOAL\"/></Provides></RealTimeLinkService></Configuration>"},
    {"E0202", R"(<EventService><Event name="A" id="1" severity="low"/><Event name="B" id="@1" severity="low"/></EventService>)"},
    {"E0202", "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"/>\n<Configuration name=\"D\" id=\"@1\" sampling_us=\"100\"/>"},
    {"E0202", R"(<Enumeration name="A"><Text value="1">a</Text>@<Text value="1">b</Text></Enumeration><ParamRef name="X" id="2" type="INT8" enumeration="A"/>)"},
    {"E0258", R"(<Enumeration name="@A"><Text value="1">a</Text></Enumeration>)", "leave it out"},
    {"E0258", R"(<Enumeration name="@A"><Text value="1">a</Text></Enumeration><Enumeration name="B"><Text value="1">a</Text></Enumeration><ParamRef name="X" id="2" type="INT8" enumeration="B"/>)"},
    {"E0203", "<ParamRef name=\"X\" id=\"2\" type=\"INT8\"/>\n<ParamRef name=\"Y\" id=\"@2\" type=\"INT8\"/>", "together"},
    {"E0203", R"(<ParamRef name="X" id="2" type="INT8"/><StructRef name="A" id="1"><ParamRef name="Y" id="@2" type="INT8"/></StructRef>)"},
    {"E0204", R"(<HKService id="1" interval="1"><SampledOnce><ParamRef name="@CUR_VALUE"/></SampledOnce></HKService>)", "'CUR_VALUES'? (line 3)"},
    {"E0204", R"(<HKService id="1" interval="1"><SampledOnce><ParamRef name="@CUR_VALUES.SPEED"/></SampledOnce></HKService>)"},
    {"E0204", R"(<Configuration name="C" id="1" sampling_us="100"><Set parameter="@GAOL" value="0"/></Configuration>)", "'GOAL'"},
    {"E0205", R"(<StructRef name="A" id="1"><ParamRef name="STATE" id="2" type="INT8"/></StructRef><HKService id="1" interval="1"><SampledOnce><ParamRef name="@STATE"/></SampledOnce></HKService>)", "'A.STATE' 'CUR_VALUES.STATE'"},
    {"E0210", R"(<ParamRef name="X" id="2" type="INT8" enumeration="@PHASES"/>)"},
    {"E0211", "<HKService id=\"1\" interval=\"1\"><SampledOnce><ParamRef name=\"GOAL\"/></SampledOnce></HKService>\n<HKService id=\"@1\" interval=\"1\"><SampledOnce><ParamRef name=\"GOAL\"/></SampledOnce></HKService>"},
    {"E0211", "<HKService id=\"1\" interval=\"1\"><SampledOnce><ParamRef name=\"GOAL\"/></SampledOnce></HKService>\n<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"><HKService id=\"@1\" interval=\"1\"><SampledOnce><ParamRef name=\"GOAL\"/></SampledOnce></HKService></Configuration>"},
    {"E0212", "<FunctionService/>\n@<FunctionService/>", "line 2"},
    {"E0212", "<EventService/>\n@<EventService/>"},
    {"E0212", "<TestService/>@<TestService/>"},
    {"E0212", "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"><EventService/>@<EventService/></Configuration>"},
    {"E0213", R"(<FunctionService><Function name="@SET_STATE"/></FunctionService>)"},
    {"E0214", R"(<HKService id="1" interval="500"><SampledNREPTimes nrep="@3"><ParamRef name="GOAL"/></SampledNREPTimes></HKService>)"},
    {"E0214", R"(<HKService id="1" interval="5"><SampledNREPTimes nrep="@10"><ParamRef name="GOAL"/></SampledNREPTimes></HKService>)"},
    {"E0215", R"(@<HKService id="1" interval="510"><SampledNREPTimes nrep="510"><ParamRef name="GOAL"/></SampledNREPTimes></HKService>)", "4072"},
    {"E0215", R"(@<Device name="X"><Input><Field name="A" type="UINT8" count="1003"/></Input><Output><Field name="B" type="UINT8" count="1002"/></Output></Device>)", "1002"},
    {"E0216", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="@PLATES"><Endnode transfer="unix" address="x"/></Device></Configuration>)", "'PLATE'"},
    {"E0106", R"(<Configuration name="C" id="1" sampling_us="100">@<Device name="PLATE"/></Configuration>)"},
    {"E0106", R"(<Configuration name="C" id="1" sampling_us="100"><RealTimeLinkService>@<Requires name="R"/></RealTimeLinkService></Configuration>)"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="udp" address="@here"/></Device></Configuration>)"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="unix" address="@../x"/></Device></Configuration>)"},
    {"E0218", R"(<Device name="X" actuator="yes"><Output>@<Field name="Y" type="DOUBLE"/></Output></Device>)", "safe"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="@49"/>)", "50 to"},
    {"E0237", R"(<StructRef name="A" id="1" writable="Operational" persistent="@yes"><ParamRef name="X" id="2" type="INT8" minimum="0" maximum="1"/></StructRef>)"},
    {"E0236", R"(<ParamRef name="X" id="2" type="DOUBLE" protection="yes" persistent="@yes"/>)", "loosened"},
    {"E0237", R"(<ParamRef name="X" id="2" type="DOUBLE" persistent="@yes"/>)", "by itself"},
    {"E0237", R"(<ParamRef name="X" id="2" type="DOUBLE" writable="Operational" minimum="0" maximum="1" persistent="@yes"/>)", "may move"},
    {"E0238", "<ParamRef name=\"X\" id=\"2\" type=\"INT8\" writable=\"PreOperational\" minimum=\"0\" maximum=\"1\" persistent=\"yes\"/>\n<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"><Set parameter=\"@X\" value=\"0\"/></Configuration>", "one of the two"},
    {"E0239", R"(<ParamRef name="X" id="2" type="INT8" count="797" writable="PreOperational" minimum="0" maximum="1" persistent="@yes"/>)", "800 at most"},
    {"E0239", "<ParamRef name=\"X\" id=\"2\" type=\"INT8\" count=\"700\" writable=\"PreOperational\" minimum=\"0\" maximum=\"1\" persistent=\"yes\"/>\n<ParamRef name=\"Y\" id=\"3\" type=\"INT8\" count=\"93\" writable=\"PreOperational\" minimum=\"0\" maximum=\"1\" persistent=\"@yes\"/>"},
    {"E0224", R"(<ParamRef name="X" id="2" type="DOUBLE" @read_only="yes"/>)", "'writable'"},
    {"E0224", R"(<StructRef name="A" id="1" @read_only="no"><ParamRef name="X" id="9" type="INT8"/></StructRef>)"},
    {"E0102", R"(<Resources><Pool block="64" count="512"/>@<Memory maximum="64MiB"/></Resources>)"},
    {"E0112", R"(<Resources memory_kB="@4095"/>)", "4096"},
    {"E0112", R"(<Resources descriptors="@23"/>)", "24"},
    {"E0112", R"(<Resources warning_percent="@101"/>)", "100"},
    {"E0112", R"(<Resources><Pool block="@15" count="1"/></Resources>)", "16"},
    {"E0105", R"(<Resources>@<Pool block="16"/></Resources>)", ""},
    {"E0241", R"(<EventService><Event name="STATE_FAILED" severity="high" safety="@no"/></EventService>)", "leave safety out"},
    {"E0113", R"(<EventService><Event name="A" id="1" severity="low" safety="@true"/></EventService>)"},
    {"E0240", R"(<Resources><Pool block="17" count="1"/>@<Pool block="32" count="1"/></Resources>)", "one pool"},
    {"E0240", R"(@<Resources memory_kB="4096"><Pool block="1048576" count="5"/></Resources>)", "4194304"},
    {"E0112", R"(<Resources waiting_answers="@127"/>)", "128"},
    {"E0112", R"(<Resources cycle_commands="@15"/>)", "16"},
    {"E0112", R"(<Resources cycle_events_kB="@15"/>)", "16"},
    {"E0112", R"(<Resources channel_kB="@417"/>)", "416"},
    {"E0112", R"(<Resources cycle_housekeeping_kB="@4097"/>)", "4096"},
    {"E0369", R"(@<Resources cycle_commands="1024" cycle_answers_kB="32"/>)", "cycle_answers_kB"},
    {"E0359", R"(@<Resources memory_kB="4096" waiting_events="8192"/>)", "4194304"},
    {"E0359", R"(@<Resources memory_kB="4096"><Pool block="1048576" count="3"/></Resources>)", "4194304"},
    {"E0107", R"(<Resources/>@<Resources/>)"},
    {"E0224", R"(<FunctionService><Function name="X" @id="1"/></FunctionService>)", "name"},
    {"E0103", "<Enumeration name=\"A\"><Text value=\"1\">a</Text></Enumeration>\n<Device name=\"L\"><Input><Field name=\"Q\" type=\"INT8\" @enumeration=\"A\"/></Input></Device>"},
    {"E0103", "<Enumeration name=\"A\"><Text value=\"1\">a</Text></Enumeration>\n<RealTimeLinkService><Requires name=\"R\"><Field name=\"Q\" type=\"INT8\" @enumeration=\"A\"/></Requires></RealTimeLinkService>"},
    {"E0224", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="@can" address="x"/></Device></Configuration>)", "shared_memory"},
    {"E0224", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="@ethercat" address="127.0.0.1:5000"/></Device></Configuration>)", "tcp"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="tcp" address="@here"/></Device></Configuration>)", "host:port"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="serial" address="@/tmp/x"/></Device></Configuration>)", "/dev"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="serial" address="@/dev/../tmp/x"/></Device></Configuration>)"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="serial" address="@/dev/ttyS0@12345"/></Device></Configuration>)", "speed"},
    {"E0217", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="message_queue" address="@a/b"/></Device></Configuration>)", "name"},
    {"E0348", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output></Device><Configuration name="C" id="1" sampling_us="100"><Device name="L"><Endnode transfer="serial" address="/dev/ttyS0" framing="@raw"/></Device></Configuration>)", "second inhibit"},
    {"E0224", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="@can" address="/dev/ttyS0"/></Device>)"},
    {"E0224", R"(<RealTimeLinkService><Provides name="A" methods="@tipc"><ParamRef name="GOAL"/></Provides></RealTimeLinkService>)", "shared_memory and udp are"},
    {"E0224", R"(<RealTimeLinkService><Provides name="A" methods="@shared_memory dds"><ParamRef name="GOAL"/></Provides></RealTimeLinkService>)"},
    {"E0224", R"(<RealTimeLinkService><Requires name="A" methods="@udp" kind="queued"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)", "'udp' carries latest"},
    {"E0224", R"(<RealTimeLinkService><Provides name="A" methods="@shared_memory udp" kind="queued"><ParamRef name="GOAL"/></Provides></RealTimeLinkService>)", "leave the method out"},
    {"E0224", R"(<RealTimeLinkService><Provides name="A" methods="udp" kind="@latest queued"><ParamRef name="GOAL"/></Provides></RealTimeLinkService>)", "'queued' goes by shared_memory"},
    {"E0224", R"(<RealTimeLinkService><Provides name="A" methods="@udp" kind="loaned"><Field name="X" type="INT8"/></Provides></RealTimeLinkService>)", "'udp' carries latest"},
    {"E0233", R"(<RealTimeLinkService><Requires name="A" depth="@8"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)", "queued"},
    {"E0233", R"(<RealTimeLinkService><Requires name="A" kind="latest" depth="@8"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)"},
    {"E0233", R"(<RealTimeLinkService><Requires name="A" kind="loaned" depth="@8"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)"},
    {"E0233", R"(<RealTimeLinkService><Requires name="A" kind="@queued latest"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)", "second set"},
    {"E0233", R"(<RealTimeLinkService><Requires name="A" kind="@latest queued" depth="8"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)"},
    {"E0112", R"(<RealTimeLinkService><Requires name="A" kind="queued" depth="@1"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)", "4096"},
    {"E0112", R"(<RealTimeLinkService><Requires name="A" kind="queued" depth="@4097"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)"},
    {"E0103", R"(<RealTimeLinkService><Provides name="A" kind="queued" @depth="8"><ParamRef name="GOAL"/></Provides></RealTimeLinkService>)"},
    {"E0215", R"(<RealTimeLinkService>@<Requires name="A" kind="queued" depth="4096"><Field name="X" type="DOUBLE" count="2049"/></Requires></RealTimeLinkService>)", "67108864"},
    {"E0231", R"(<RealTimeLinkService><Provides name="A" kind="loaned">@<ParamRef name="GOAL"/><Field name="X" type="INT8"/></Provides></RealTimeLinkService>)", "<Field"},
    {"E0231", R"(<RealTimeLinkService><Provides name="A" kind="@loaned latest"><Field name="X" type="INT8"/></Provides></RealTimeLinkService>)", "second set"},
    {"E0231", R"(<RealTimeLinkService><Requires name="A" kind="@latest loaned"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)"},
    {"E0231", R"(<RealTimeLinkService><Requires name="A" kind="loaned" byte_order="@little"><Field name="X" type="INT8"/></Requires></RealTimeLinkService>)", "native"},
    {"E0106", R"(<RealTimeLinkService>@<Provides name="A" kind="loaned"/></RealTimeLinkService>)"},
    {"E0102", R"(<RealTimeLinkService><Provides name="A">@<Field name="X" type="INT8"/></Provides></RealTimeLinkService>)"},
    {"E0112", R"(<RealTimeLinkService><Requires name="A"><Field name="X" type="INT8" count="@4097"/></Requires></RealTimeLinkService>)", "4096"},
    {"E0112", R"(<RealTimeLinkService><Requires name="A" kind="loaned"><Field name="X" type="INT8" count="@16777217"/></Requires></RealTimeLinkService>)", "16777216"},
    {"E0215", R"(<RealTimeLinkService>@<Requires name="A" kind="loaned"><Field name="X" type="DOUBLE" count="2097152"/><Field name="Y" type="INT8"/></Requires></RealTimeLinkService>)", "16777216"},
    {"E0215", R"(<RealTimeLinkService>@<Provides name="A" kind="loaned"><Field name="Y" type="INT8"/><Field name="X" type="DOUBLE" count="2097152"/></Provides></RealTimeLinkService>)", "16777216"},
    {"E0201", R"(<RealTimeLinkService><Provides name="A" kind="loaned"><Field name="X" type="INT8"/>@<Field name="X" type="INT8"/></Provides></RealTimeLinkService>)"},
    {"E0225", R"(<FunctionService>@<Function name="X"><Argument name="A" type="DOUBLE" count="31" minimum="0" maximum="1"/><Argument name="B" type="TEXT" octets="7"/></Function></FunctionService>)", "at most 256"},
    {"E0104", R"(<FunctionService><Function name="X"><Argument name="A" type="@STRUCT" minimum="0" maximum="1"/></Function></FunctionService>)"},
    {"E0105", R"(@<ParamRef name="X" id="2" type="TEXT"/>)"},
    {"E0112", R"(<ParamRef name="X" id="2" type="TEXT" octets="@255"/>)", "1 to 254"},
    {"E0103", R"(<ParamRef name="X" id="2" type="TEXT" octets="8" @count="2"/>)"},
    {"E0103", R"(<ParamRef name="X" id="2" type="BOOL" @minimum="0"/>)"},
    {"E0207", R"(<ParamRef name="X" id="2" type="TEXT" octets="2" init="@abc"/>)"},
    {"E0208", R"(<ParamRef name="X" id="2" type="BOOL" init="@2"/>)", "0 to 1"},
    {"E0111", R"(<ParamRef name="X" id="2" type="BOOL" init="@tru"/>)", "'true'"},
    {"E0209", R"(<ParamRef name="X" id="2" type="BOOL" count="2" init="@true"/>)"},
    {"E0209", R"(<ParamRef name="X" id="2" type="DOUBLE" init="@1 2"/>)"},
    {"E0109", R"(<ParamRef name="X" id="2" type="BOOL" init="@"/>)"},
    {"E0111", "<ParamRef name=\"X\" id=\"2\" type=\"UINT8\" enumeration=\"C\" init=\"@gren\"/>\n<Enumeration name=\"C\"><Text value=\"3\">green</Text></Enumeration>", "'green'"},
    {"E0208", "<StructRef name=\"W\" id=\"7\"><ParamRef name=\"A\" id=\"8\" type=\"TEXT\" octets=\"4\"/><ParamRef name=\"B\" id=\"8\" type=\"BOOL\"/></StructRef>\n<Configuration name=\"C\" id=\"1\" sampling_us=\"100\"><Set parameter=\"W\" value=\"@a 1\"/></Configuration>", "one by one"},
    {"E0201", R"(<Configuration name="C" id="1" sampling_us="100"><Set parameter="GOAL" value="0"/><Set parameter="@GOAL" value="1"/></Configuration>)"},
    {"E0105", R"(<Configuration name="C" id="1" sampling_us="100">@<Set parameter="GOAL"/></Configuration>)"},
    {"E0105", R"(<Configuration name="C" id="1" sampling_us="100">@<Set value="1"/></Configuration>)"},
    {"E0111", R"(<Configuration name="C" id="1" sampling_us="100"><Set parameter="GOAL" value="@x"/></Configuration>)"},
    {"E0102", R"(<Configuration name="C" id="1" sampling_us="100">@<Initial/></Configuration>)"},
    {"E0104", "<ParamRef name=\"ON\" id=\"2\" type=\"BOOL\"/>\n<RealTimeLinkService><Provides name=\"A\"><ParamRef name=\"@ON\"/></Provides></RealTimeLinkService>", "UINT8"},
    {"E0104", "<StructRef name=\"W\" id=\"7\"><ParamRef name=\"A\" id=\"8\" type=\"TEXT\" octets=\"4\"/></StructRef>\n<RealTimeLinkService><Provides name=\"A\"><ParamRef name=\"@W\"/></Provides></RealTimeLinkService>", "housekeeping"},
    {"E0104", R"(<RealTimeLinkService><Requires name="A"><Field name="X" type="@BOOL"/></Requires></RealTimeLinkService>)", "carry numbers"},
    {"E0104", R"(<RealTimeLinkService><Provides name="A" kind="loaned"><Field name="X" type="@TEXT"/></Provides></RealTimeLinkService>)", "carry numbers"},
    {"E0104", R"(<Device name="D"><Input><Field name="X" type="@BOOL"/></Input></Device>)", "carry numbers"},
    {"E0104", R"(<Device name="D"><Output><Field name="X" type="@TEXT"/></Output></Device>)", "carry numbers"},
    {"E0104", R"(<EventService><Event name="E" id="1" severity="low"><Argument name="A" type="@BOOL"/></Event></EventService>)"},
    {"E0105", R"(<EventService><Event name="E" id="1" severity="low">@<Argument name="A" type="TEXT"/></Event></EventService>)"},
    {"E0112", R"(<EventService><Event name="E" id="1" severity="low"><Argument name="A" type="TEXT" octets="@255"/></Event></EventService>)"},
    {"E0103", R"(<EventService><Event name="E" id="1" severity="low"><Argument name="A" type="TEXT" octets="9" @count="2"/></Event></EventService>)"},
    {"E0103", R"(<CustomService name="A" type="200"><Request name="X" subtype="1"><Argument name="N" type="BOOL" @minimum="0"/></Request></CustomService>)"},
    {"E0103", R"(<CustomService name="A" type="200"><Request name="X" subtype="1"/><Report name="Y" subtype="2"><Field name="N" type="DOUBLE" @minimum="0"/></Report></CustomService>)"},
    {"E0105", R"(<CustomService name="A" type="200"><Request name="X" subtype="1"/><Report name="Y" subtype="2">@<Field name="N" type="TEXT"/></Report></CustomService>)"},
    {"E0105", R"(<FunctionService><Function name="X">@<Argument name="A" type="TEXT"/></Function></FunctionService>)"},
    {"E0112", R"(<FunctionService><Function name="X"><Argument name="A" type="TEXT" octets="@255"/></Function></FunctionService>)"},
    {"E0103", R"(<FunctionService><Function name="X"><Argument name="A" type="TEXT" octets="9" @count="2"/></Function></FunctionService>)"},
    {"E0103", R"(<FunctionService><Function name="X"><Argument name="A" type="BOOL" @minimum="0"/></Function></FunctionService>)"},
    {"E0103", R"(<FunctionService><Function name="X"><Argument name="A" type="INT8" minimum="0" maximum="1" @octets="2"/></Function></FunctionService>)"},
    {"E0207", R"(<FunctionService><Function name="X"><Argument name="A" type="TEXT" octets="2" default="@abc"/></Function></FunctionService>)"},
    {"E0207", "<Enumeration name=\"C\"><Text value=\"3\">c</Text></Enumeration>\n<FunctionService><Function name=\"X\">@<Argument name=\"A\" type=\"UINT8\" enumeration=\"C\" default=\"2\"/></Function></FunctionService>"},
    {"E0208", "<Enumeration name=\"C\"><Text value=\"256\">c</Text></Enumeration>\n<FunctionService><Function name=\"X\">@<Argument name=\"A\" type=\"UINT8\" enumeration=\"C\"/></Function></FunctionService>"},
    {"E0208", R"(<FunctionService><Function name="X"><Argument name="A" type="UINT64" minimum="0" maximum="@18446744073709551616"/></Function></FunctionService>)", "0 to 18446744073709551615"},
    {"E0208", R"(<FunctionService><Function name="X"><Argument name="A" type="INT64" minimum="@-9223372036854775809" maximum="0"/></Function></FunctionService>)"},
    {"E0206", R"(<FunctionService><Function name="X"><Argument name="A" type="UINT64" minimum="@9007199254740993" maximum="9007199254740992"/></Function></FunctionService>)"},
    {"E0226", R"(<ParamRef name="A" id="2" type="DOUBLE"/>@<ParamRef name="a" id="3" type="DOUBLE"/>)", "one"},
    {"E0226", R"(<ParamRef name="A" id="2" type="DOUBLE"/>@<StructRef name="a" id="3"><ParamRef name="X" id="9" type="INT8"/></StructRef>)"},
    {"E0226", R"(<EventService><Event name="A" id="2" severity="low"/>@<Event name="a" id="3" severity="low"/></EventService>)"},
    {"E0226", R"(<Configuration name="C" id="1" sampling_us="100"/>@<Configuration name="c" id="2" sampling_us="100"/>)"},
    {"E0226", R"(<Device name="L"><Input><Field name="Q" type="DOUBLE"/></Input></Device>@<Device name="l"><Input><Field name="Q" type="DOUBLE"/></Input></Device>)"},
    {"E0226", R"(<RealTimeLinkService><Provides name="A"><ParamRef name="GOAL"/></Provides>@<Provides name="a"><ParamRef name="GOAL"/></Provides></RealTimeLinkService>)"},
    {"E0228", R"(<FunctionService><Function name="X">@<Argument name="A" type="DOUBLE"/></Function></FunctionService>)", "minimum and maximum"},
    {"E0228", R"(<FunctionService><Function name="X">@<Argument name="A" type="UINT8" minimum="1"/></Function></FunctionService>)"},
    {"E0228", R"(@<ParamRef name="X" id="2" type="DOUBLE" writable="PreOperational"/>)"},
    {"E0228", R"(@<ParamRef name="X" id="2" type="DOUBLE" writable="PreOperational" maximum="9"/>)"},
    {"E0228", R"(<StructRef name="A" id="1" writable="Operational">@<ParamRef name="X" id="9" type="INT8"/></StructRef>)"},
    {"E0229", R"(<Configuration name="C" id="1" sampling_us="10000">@<Device name="PLATE"><Endnode transfer="unix" address="x"/></Device></Configuration>)", "watchdog_ms"},
    {"E0229", R"(<Configuration name="C" id="1" sampling_us="1000">@<Device name="PLATE" watchdog_ms="1"><Endnode transfer="unix" address="x"/></Device></Configuration>)"},
    {"E0230", R"(<Configuration name="B" id="1" sampling_us="100"/><Configuration name="C" id="2" sampling_us="100"><EventService>@<Event name="A" id="1" severity="low"/></EventService></Configuration>)", "<Subsystem>"},
    {"E0230", R"(<Configuration name="B" id="1" sampling_us="100"><EventService>@<Event name="A" id="1" severity="low"/></EventService></Configuration><Configuration name="C" id="2" sampling_us="100"/>)"},
    {"E0230", R"(<Configuration name="B" id="1" sampling_us="100"/><Configuration name="C" id="2" sampling_us="100"><FunctionService>@<Function name="A"/></FunctionService></Configuration>)", "<Subsystem>"},
    {"E0227", R"(<Configuration name="C" id="1" sampling_us="100" budget_us="@101"/>)", "at most"},
    {"E0227", R"(<Configuration name="C" id="1" sampling_us="1000" started_by="S" least_us="100" budget_us="@101"><RealTimeLinkService><Requires name="S"><Field name="A" type="INT8"/></Requires></RealTimeLinkService></Configuration>)", "least distance"},
    {"E0250", R"(<Configuration name="C" id="1" sampling_us="100" started_by="@S"><RealTimeLinkService><Requires name="S"><Field name="A" type="INT8"/></Requires></RealTimeLinkService></Configuration>)", "both"},
    {"E0250", R"(<Configuration name="C" id="1" sampling_us="100" least_us="@50"/>)", "both"},
    {"E0250", R"(<Configuration name="C" id="1" sampling_us="100" started_by="S" least_us="@101"><RealTimeLinkService><Requires name="S"><Field name="A" type="INT8"/></Requires></RealTimeLinkService></Configuration>)", "longest wait"},
    {"E0251", R"(<Configuration name="C" id="1" sampling_us="100" started_by="@SET" least_us="50"><RealTimeLinkService><Requires name="SAT"><Field name="A" type="INT8"/></Requires></RealTimeLinkService></Configuration>)", "'SAT'"},
    {"E0251", R"(<Configuration name="C" id="1" sampling_us="100" started_by="@S" least_us="50"/>)"},
    {"E0252", R"(<Configuration name="C" id="1" sampling_us="100" started_by="@S" least_us="50"><RealTimeLinkService><Requires name="S" methods="udp"><Field name="A" type="INT8"/></Requires></RealTimeLinkService></Configuration>)", "shared_memory"},
    {"E0253", R"(<Configuration name="C" id="1" sampling_us="500" budget_us="100" spin_us="@80"/>)", "priority"},
    {"E0253", R"(<Configuration name="C" id="1" sampling_us="500" priority="80" spin_us="@80"/>)", "budget_us"},
    {"E0253", R"(<Configuration name="C" id="1" sampling_us="500" priority="80" budget_us="421" spin_us="@80"/>)", "lower spin_us"},
    {"E0253", R"(<Configuration name="C" id="1" sampling_us="500" priority="80" budget_us="50" spin_us="@80" started_by="S" least_us="250"><RealTimeLinkService><Requires name="S"><Field name="A" type="INT8"/></Requires></RealTimeLinkService></Configuration>)", "clock"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="5000" priority="80" budget_us="50" spin_us="@1001"/>)", "1 to 1000"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="5000" priority="80" budget_us="50" spin_us="@0"/>)", "1 to 1000"},
    {"E0229", R"(<Configuration name="C" id="1" sampling_us="10000" started_by="S" least_us="50"><RealTimeLinkService><Requires name="S"><Field name="A" type="INT8"/></Requires></RealTimeLinkService>@<Device name="PLATE"><Endnode transfer="unix" address="x"/></Device></Configuration>)", "watchdog_ms"},
    {"E0113", R"(<Configuration name="C" id="1" sampling_us="100" self_test="@requried"/>)", "'required'"},
    {"E0113", R"(<Configuration name="C" id="1" sampling_us="100" self_test="@yes"/>)", "optional"},
    {"E0103", R"(<TestService @self_test_within="5"/>)", "'self_test_within_ms'"},
    {"E0112", R"(<TestService self_test_within_ms="@0"/>)", "600000"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="100"><TestService self_test_within_ms="@600001"/></Configuration>)"},
    {"E0111", R"(<TestService self_test_within_ms="@2s"/>)"},
    {"E0212", R"(<TestService/>@<TestService self_test_within_ms="5"/>)"},
    {"E0213", R"(<FunctionService><Function name="@SELF_TEST"/></FunctionService>)", ""},
    {"E0213", R"(<FunctionService><Function name="@PING"/></FunctionService>)", ""},
    {"E0213", R"(<CustomService name="A" type="200"><Request name="@REPORT_SELF_TEST" subtype="1"/></CustomService>)", ""},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="100" budget_us="@0"/>)"},
    {"E0219", R"(<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" writable="@Operational" protection="yes"/>)", "its own function"},
    {"E0219", R"(<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" protection="yes"/><FunctionService><Function name="A"><Argument name="V" of="X"/></Function><Function name="B"><Argument name="V" of="@X"/></Function></FunctionService>)", "one function"},
    {"E0219", R"(<StructRef name="A" id="1" writable="@Operational" protection="yes"><ParamRef name="X" id="9" type="INT8" minimum="0" maximum="1"/></StructRef>)"},
    {"E0219", R"(<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" protection="yes"/><FunctionService><Function name="A" sets="X"/><Function name="B"><Argument name="V" of="@X"/></Function></FunctionService>)", "one function"},
    {"E0219", R"(<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" protection="yes"/><FunctionService><Function name="A" sets="X"/></FunctionService><CustomService name="C" type="200"><Request name="B" subtype="1" sets="GOAL @X"/></CustomService>)", "one function"},
    {"E0109", R"(<FunctionService><Function name="A" sets="@ "/></FunctionService>)"},
    {"E0113", R"(<FunctionService><Function name="A" sets="GOAL @GOAL"/></FunctionService>)"},
    {"E0204", R"(<FunctionService><Function name="A" sets="GOAL @GAOL"/></FunctionService>)", "'GOAL'"},
    {"E0204", R"(<CustomService name="C" type="200"><Request name="A" subtype="1" sets="@LIMIT"/></CustomService>)"},
    {"E0354", R"(<FunctionService><Function name="A" sets="GOAL @CYCLE_STATS"/></FunctionService>)", "stores"},
    {"E0355", R"(@<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" protection="yes"/>)", "minimum = maximum"},
    {"E0355", R"(@<ParamRef name="X" id="2" type="DOUBLE" protection="yes"/>)", "sets"},
    {"E0355", R"(@<ParamRef name="X" id="2" type="BOOL" protection="yes"/>)"},
    {"E0355", R"(@<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" protection="yes"/><FunctionService><Function name="A" sets="GOAL"/></FunctionService>)"},
    {"E0355", R"(@<StructRef name="A" id="1" protection="yes"><ParamRef name="X" id="9" type="INT8" minimum="0" maximum="1"/><ParamRef name="Y" id="8" type="INT8" minimum="0" maximum="1"/></StructRef><FunctionService><Function name="F"><Argument name="V" of="A.X"/></Function></FunctionService>)"},
    {"E0113", R"(<ParamRef name="X" id="2" type="DOUBLE" minimum="0" maximum="1" writable="@Operatonal"/>)", "'Operational'"},
    {"E0109", R"(<ParamRef name="X" id="2" type="DOUBLE" writable="@"/>)"},
    {"E0220", R"(<FunctionService><Function name="X"><Argument name="A" of="GOAL" @unit="N m"/></Function></FunctionService>)", "unit"},
    {"E0220", R"(<FunctionService><Function name="X"><Argument name="A" of="GOAL" @maximum="2"/></Function></FunctionService>)"},
    {"E0204", R"(<FunctionService><Function name="X"><Argument name="A" of="@GAOL"/></Function></FunctionService>)", "'GOAL'"},
    {"E0207", R"(<FunctionService><Function name="X"><Argument name="A" of="GOAL" default="@2"/></Function></FunctionService>)"},
    {"E0221", R"(<FunctionService><Function name="X"><Argument name="A" of="@POSITION"/></Function></FunctionService>)", "minimum and maximum"},
    {"E0221", R"(<FunctionService><Function name="X"><Argument name="A" of="@CUR_VALUES"/></Function></FunctionService>)", "members"},
    {"E0222", R"(<Device name="L"><Input><Field name="Q" type="INT8"/></Input></Device><Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="unix" address="x"/></Device><Device name="L">@<Endnode transfer="unix" address="x"/></Device></Configuration>)", "1"},
    {"E0222", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x"/></Device><Configuration name="C" id="1" sampling_us="100"><Device name="L">@<Endnode transfer="unix" address="x"/></Device></Configuration>)"},
    {"E0106", R"(<Device name="L">@<Endnode name="A"/></Device>)"},
    {"E0381", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output>@<Enable transfer="unix" address="x"><FallBack transfer="unix" address="y"/></Enable></Device>)", "silence_ms"},
    {"E0381", R"(<Device name="L"><Input><Field name="Q" type="INT8"/></Input>@<Power transfer="unix" address="x"><FallBack transfer="unix" address="y"/></Power></Device>)"},
    {"E0382", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_ms="30" goes_on="@yes"/></Device>)", "FallBack"},
    {"E0383", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_ms="36" goes_on="@yes"><FallBack transfer="unix" address="y"/></Enable></Device>)", "at most 35"},
    {"E0383", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_ms="30" silence_reduced_ms="86" goes_on="@yes"><FallBack transfer="unix" address="y"/></Enable></Device>)", "at most 85"},
    {"E0384", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_reduced_ms="@90"/></Device>)", "silence_ms"},
    {"E0112", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_ms="@14"/></Device>)"},
    {"E0112", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_ms="@1001"/></Device>)"},
    {"E0222", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" silence_ms="30">@<FallBack transfer="unix" address="x"/></Enable></Device>)", "of its own"},
    {"E0103", R"(<Device name="L"><Input><Field name="Q" type="INT8"/></Input><Power transfer="unix" address="x" silence_ms="30" @goes_on="yes"/></Device>)"},
    {"E0201", R"(<Device name="L"><Endnode name="A"><Input><Field name="Q" type="INT8"/></Input></Endnode>@<Endnode name="A"><Input><Field name="Q" type="INT8"/></Input></Endnode></Device>)"},
    {"E0102", R"(<Device name="L"><Endnode name="A"><Input><Field name="Q" type="INT8"/></Input></Endnode>@<Input><Field name="Q" type="INT8"/></Input></Device>)"},
    {"E0102", R"(<Device name="L"><Endnode name="A"><Input><Field name="Q" type="INT8"/></Input>@<Power transfer="unix" address="p"/></Endnode></Device>)"},
    {"E0103", R"(<Device name="L" @actuator="yes"><Endnode name="A"><Input><Field name="Q" type="INT8"/></Input></Endnode></Device>)"},
    {"E0114", R"(<Device name="L23456789012345678901234567890123">@<Endnode name="A23456789012345678901234567890123"><Input><Field name="Q" type="INT8"/></Input></Endnode></Device>)", "64"},
    {"E0216", R"(<Device name="L"><Endnode name="IMAGE"><Input><Field name="Q" type="INT8"/></Input></Endnode></Device><Configuration name="C" id="1" sampling_us="100"><Device name="L"><Endnode name="@IMGE" transfer="unix" address="x"/></Device></Configuration>)", "'L.IMAGE'"},
    {"E0106", R"(<Device name="L"><Endnode name="A"><Input><Field name="Q" type="INT8"/></Input></Endnode></Device><Configuration name="C" id="1" sampling_us="100">@<Device name="L"/></Configuration>)"},
    {"E0222", R"(<Device name="L"><Input><Field name="Q" type="INT8"/></Input><Power transfer="unix" address="x"/></Device><Configuration name="C" id="1" sampling_us="100"><Device name="PLATE">@<Endnode transfer="unix" address="x"/></Device></Configuration>)"},
    {"E0222", R"(<Configuration name="C" id="1" sampling_us="100"><Device name="PLATE"><Endnode transfer="unix" address="x">@<FallBack transfer="unix" address="x"/></Endnode></Device></Configuration>)", "of its own"},
    {"E0229", R"(<Configuration name="C" id="1" sampling_us="1000">@<Device name="PLATE" every="10" silence="20"><Endnode transfer="unix" address="x"/></Device></Configuration>)", "watchdog_ms"},
    {"E0234", R"(<Configuration name="C" id="1" sampling_us="1000">@<Device name="PLATE" every="3"><Endnode transfer="unix" address="x"/></Device></Configuration>)", "more than those"},
    {"E0235", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output></Device><Configuration name="C" id="1" sampling_us="1000">@<Device name="L" silence="9"><Endnode transfer="unix" address="x"><FallBack transfer="unix" address="y"/></Endnode></Device></Configuration>)", "less silence"},
    {"E0112", R"(<Configuration name="C" id="1" sampling_us="1000"><Device name="PLATE" every="@0"><Endnode transfer="unix" address="x"/></Device></Configuration>)"},
    {"E0223", R"(<Device name="L" stop="@drop"><Input><Field name="Q" type="INT8"/></Input></Device>)", "actuator"},
    {"E0223", R"(<Device name="L" stop_within_ms="@5"><Input><Field name="Q" type="INT8"/></Input></Device>)"},
    {"E0223", R"(<Device name="L"><Output><Field name="Q" type="INT8" safe="@0"/></Output></Device>)", "actuator=\"yes\""},
    {"E0223", R"(<Device name="L"><Endnode name="A"><Output><Field name="Q" type="INT8" safe="@0"/></Output></Endnode></Device>)", "leave it out"},
    {"E0223", R"(<Device name="L"><Input><Field name="Q" type="INT8"/></Input>@<Enable transfer="unix" address="x"/></Device>)"},
    {"E0103", R"(<Device name="L" actuator="yes"><Output><Field name="Q" type="INT8" safe="0"/></Output><Enable transfer="unix" address="x" @byte_order="big"/></Device>)"},
    {"E0105", R"(@<Device name="L" actuator="yes" stop="controlled"><Output><Field name="Q" type="INT8" safe="0"/></Output></Device>)", "rest"},
    {"E0112", R"(<Device name="L" actuator="yes" stop_within_ms="@0"><Output><Field name="Q" type="INT8" safe="0"/></Output></Device>)"},
    {"E0113", R"(<Device name="L" actuator="yes" stop="@controled"><Output><Field name="Q" type="INT8" safe="0"/></Output></Device>)", "'controlled'"},
    {"E0106", R"(@<Device name="X" actuator="yes"><Input><Field name="Y" type="DOUBLE"/></Input></Device>)"},
};
// clang-format on

void expect_problem(const Bad& bad, const std::string& text) {
  const auto expected = marked(text);
  const auto reading = read_text(expected.text);
  const std::string found = rendered(reading.problems, text_source(expected.text));
  EXPECT_FALSE(reading.value) << expected.text;
  ASSERT_EQ(reading.problems.size(), 1U) << bad.code << " expected for\n" << text << "\nfound:\n" << found;
  const Diagnostic& problem = reading.problems.front();
  EXPECT_EQ(problem.code, bad.code) << found;
  EXPECT_EQ(problem.at.line, expected.at.line) << found;
  EXPECT_EQ(problem.at.column, expected.at.column) << found;
  EXPECT_FALSE(problem.message.empty());
  EXPECT_NE(problem.hint.find(bad.hint == nullptr ? "" : bad.hint), std::string::npos) << found;
}

TEST(SubsystemErrors, TheSubsystemAroundTheMistakesIsGood) {
  const auto reading = read_text(whole(""));
  EXPECT_TRUE(reading.value.has_value()) << rendered(reading.problems, text_source(whole("")));
}
TEST(SubsystemErrors, ElementsAndAttributesAreReportedWhereTheyStand) {
  for (const Bad& bad : bad_elements) expect_problem(bad, whole(bad.body));
}
TEST(SubsystemErrors, ValuesAreReportedWhereTheyStand) {
  for (const Bad& bad : bad_values) expect_problem(bad, whole(bad.body));
}
TEST(SubsystemErrors, ContradictionsAreReportedWhereTheyStand) {
  for (const Bad& bad : bad_meaning) expect_problem(bad, whole(bad.body));
}
TEST(SubsystemErrors, TheTableIsAsLongAsPromised) {
  EXPECT_GE(std::size(bad_elements) + std::size(bad_values) + std::size(bad_meaning), 100U);
}

TEST(SubsystemErrors, TheHeadIsChecked) {
  expect_problem({"E0101", ""}, "@<Mission name=\"S\" id=\"10\"/>");
  expect_problem({"E0105", ""}, "@<Subsystem id=\"10\"/>");
  expect_problem({"E0112", ""}, "<Subsystem name=\"S\" id=\"@2040\"/>");
  expect_problem({"E0112", ""}, "<Subsystem name=\"S\" id=\"@0\"/>");
  expect_problem({"E0002", ""}, "<Subsystem name=\"S\" id=\"10\">\n  <Parameters>\n</@Subsystem>");
  expect_problem({"E0003", ""}, "@<!DOCTYPE Subsystem []><Subsystem name=\"S\" id=\"10\"/>");
}

TEST(SubsystemErrors, AFunctionHasNoMoreArgumentsThanAHandlerTakes) {
  const auto with = [](int count) {
    std::string arguments;
    for (int i = 0; i < count; ++i)
      arguments += "<Argument name=\"A" + std::to_string(i) + "\" type=\"INT64\" minimum=\"0\" maximum=\"1\"/>";
    return "<FunctionService>@<Function name=\"X\">" + arguments + "</Function></FunctionService>";
  };
  expect_problem({"E0225", "", "at most 256"}, whole(with(33)));
  const std::string most = marked(whole(with(32))).text;
  EXPECT_TRUE(read_text(most).value) << rendered(read_text(most).problems, text_source(most));
}

TEST(SubsystemErrors, AUsedIdNamesBothPlaces) {
  const auto reading = read_text(
      "<Subsystem name=\"S\" id=\"1\">\n  <ParamRef name=\"X\" id=\"2\" type=\"INT8\"/>\n"
      "  <ParamRef name=\"Y\" id=\"2\" type=\"INT8\"/>\n</Subsystem>");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].message, "parameter id 'INT8 2' is already used in 2:26");
  EXPECT_EQ(reading.problems[0].at.line, 3);
  EXPECT_EQ(reading.problems[0].at.column, 26);
}

TEST(SubsystemErrors, AllAreReportedAtOnceInFileOrder) {
  const auto reading = read_text(
      "<Subsystem name=\"S\" id=\"1\">\n<HKService id=\"1\" interval=\"0\"><SampledOnce><ParamRef "
      "name=\"NONE\"/></SampledOnce></HKService>\n<ParamRef name=\"X\" id=\"300\" type=\"REAL\"/>\n"
      "<Nonsense/>\n</Subsystem>");
  std::string codes;
  for (const Diagnostic& problem : reading.problems) codes += problem.code + " ";
  EXPECT_EQ(codes, "E0112 E0204 E0112 E0104 E0102 ");
}

/// Structures of an octet each, those of the subsystem from id 1 on and those of its configuration behind them.
std::string structures(int of_subsystem, int of_configuration) {
  std::string text =
      "<Subsystem name=\"S\" id=\"1\"><Parameters><ParamRef name=\"X\" id=\"1\" type=\"INT8\"/></Parameters>";
  for (int i = 1; i <= of_subsystem + of_configuration; ++i) {
    if (i == of_subsystem + 1) text += "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\">";
    text += "\n<HKService id=\"" + std::to_string(i) +
            "\" interval=\"1\"><SampledOnce><ParamRef name=\"X\"/></SampledOnce></HKService>";
  }
  return text + (of_configuration > 0 ? "</Configuration></Subsystem>" : "</Subsystem>");
}

TEST(SubsystemErrors, MoreStructuresThanFlyAreToldOnceAtTheFirstTooMany) {
  EXPECT_TRUE(read_text(structures(32, 0)).value);
  EXPECT_TRUE(read_text(structures(30, 2)).value);
  for (const int of_subsystem : {40, 32, 30, 0}) {
    const auto problems = read_text(structures(of_subsystem, 40 - of_subsystem)).problems;
    ASSERT_EQ(problems.size(), 1U) << of_subsystem;
    EXPECT_EQ(problems[0].code, "E0257");
    EXPECT_EQ(problems[0].at.line, 34U) << "the 33rd structure";
  }
}

TEST(SubsystemErrors, AFileThatCannotBeReadIsAProblem) {
  const auto reading = read_subsystem("none.xml", [](const auto&) { return fail(ErrorCode::NotFound, "is gone"); });
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "E0001");
  EXPECT_EQ(reading.problems[0].message, "is gone");
}

TEST(SubsystemErrors, AFileThatIsNoneSaysWhatItIs) {
  const auto folder = std::filesystem::path{HIROSCO_BINARY_DIR} / "no_files";
  std::filesystem::create_directories(folder);
  const auto said = [&](const std::filesystem::path& file) {
    const auto reading = read_subsystem(file, file_system());
    return reading.problems.size() == 1 ? reading.problems[0].message : std::string{};
  };
  EXPECT_EQ(said(folder), "is a folder");
  EXPECT_EQ(said(folder / "none.xml"), "does not exist");
  EXPECT_EQ(said("/dev/zero"), "is a device") << "an endless file must not be read";
  const auto pipe = folder / "pipe.xml", large = folder / "large.xml", circle = folder / "circle.xml";
  std::filesystem::remove(pipe);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(said(pipe), "is a pipe (FIFO)") << "nobody writes: reading it would never end";
  std::ofstream{large} << std::string(4 * 1024 * 1024 + 1, ' ');
  EXPECT_EQ(said(large), "is larger than 4 MiB");
  std::filesystem::remove(circle);
  std::filesystem::create_symlink(circle, circle);
  EXPECT_EQ(said(circle), "is a symbolic link that leads in a circle");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace hirosco::descriptor
