#include <string>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/outside/fmu_description.hpp"

namespace mpm {
namespace {

using Catch::Contains;

std::string description(const std::string& version, const std::string& kind) {
  return "<fmiModelDescription fmiVersion=\"" + version + "\" guid=\"{1}\">" + kind +
         R"(<ModelVariables>
  <ScalarVariable name="u" valueReference="3" causality="input"><Real/></ScalarVariable>
  <ScalarVariable name="y" valueReference="0" causality="output"><Real unit="K"/></ScalarVariable>
  <ScalarVariable name="x" valueReference="8"><Real/></ScalarVariable>
  <ScalarVariable name="n" valueReference="5" causality="input"><Integer/></ScalarVariable>
  <ScalarVariable name="k" valueReference="7" causality="parameter" variability="tunable"><Real/></ScalarVariable>
</ModelVariables></fmiModelDescription>)";
}

constexpr const char* kCoSimulation = "<CoSimulation modelIdentifier=\"m\"/>";

TEST_CASE("the description of an FMU is read", "[fmu]") {
  const FmuDescription fmu = parse_fmu_description(description("2.0", kCoSimulation), "m.fmu");
  CHECK(fmu.guid == "{1}");
  CHECK(fmu.identifier == "m");
  CHECK(fmu.variable("u", FmuRole::input, "p").reference == 3);
  CHECK(fmu.variable("y", FmuRole::output, "p").reference == 0);
  CHECK(fmu.variable("x", FmuRole::output, "p").reference == 8);  // local by default
  CHECK(fmu.variable("k", FmuRole::parameter, "p").variability == "tunable");
}

TEST_CASE("the description of an FMU by FMI 3.0 is read", "[fmu]") {
  const FmuDescription fmu = parse_fmu_description(
      R"(<fmiModelDescription fmiVersion="3.0" instantiationToken="{2}">
  <!-- the order is free --><CoSimulation modelIdentifier="m"/><ModelVariables>
  <Float64 name="u" valueReference="3" causality="input"/>
  <Float64 name="y" valueReference="4" causality="output"><Alias name="alias"/></Float64>
  <Float64 name="v" valueReference="5" causality="output"><Dimension start="2"/></Float64>
  <Int32 name="n" valueReference="6" causality="input"/>
</ModelVariables></fmiModelDescription>)",
      "m.fmu");
  CHECK(fmu.version == FmiVersion::three);
  CHECK(fmu.guid == "{2}");
  CHECK(fmu.variable("u", FmuRole::input, "p").reference == 3);
  CHECK(fmu.variable("alias", FmuRole::output, "p").reference == 4);
  CHECK_THROWS_WITH(fmu.variable("v", FmuRole::output, "p"),
                    "p: found 'v' of type Float64 array; allowed: alias, y");
  CHECK_THROWS_WITH(fmu.variable("n", FmuRole::input, "p"), "p: found 'n' of type Int32; allowed: u");
  CHECK_THROWS_WITH(fmu.variable("k", FmuRole::parameter, "p"),
                    "p: found 'k', which m.fmu has not; allowed: a Float64 parameter; m.fmu has none");
}

TEST_CASE("what is no FMU is refused", "[fmu]") {
  const auto parse = [](const std::string& xml) { return parse_fmu_description(xml, "m.fmu"); };
  CHECK_THROWS_WITH(parse("<a"), Contains("m.fmu: modelDescription.xml: found") && Contains("allowed: XML"));
  CHECK_THROWS_WITH(parse("<a/>"), Contains("found no element fmiModelDescription"));
  CHECK_THROWS_WITH(parse(description("1.0", kCoSimulation)),
                    "m.fmu: modelDescription.xml: fmiVersion: found '1.0'; allowed: '2.0' or '3.0'");
  CHECK_THROWS_WITH(parse(description("3.0", kCoSimulation)),
                    Contains("instantiationToken of fmiModelDescription: found nothing"));
  CHECK(parse(description("2.0", "<ModelExchange modelIdentifier='m'/>")).kind == FmuKind::model_exchange);
  CHECK(parse(description("2.0", "<ModelExchange modelIdentifier='m'/><CoSimulation modelIdentifier='m'/>"))
            .kind == FmuKind::co_simulation);
  CHECK_THROWS_WITH(parse(description("2.0", "")),
                    Contains("found neither; allowed: co-simulation or model exchange"));
  CHECK_THROWS_WITH(
      parse(description("2.0", "<CoSimulation/>")),
      "m.fmu: modelDescription.xml: modelIdentifier of CoSimulation: found nothing; allowed: a text");
}

TEST_CASE("references and the name of the library are what FMI allows, and no path", "[fmu]") {
  const auto with_reference = [](const std::string& reference) {
    std::string xml = description("2.0", kCoSimulation);
    const std::string before = "valueReference=\"3\"";
    xml.replace(xml.find(before), before.size(), "valueReference='" + reference + "'");
    return parse_fmu_description(xml, "m.fmu");
  };
  CHECK(with_reference("4294967295").variable("u", FmuRole::input, "p").reference == 4294967295U);
  for (const char* wrong : {"three", "-1", "3.5", "4294967296", "3x", "0x3"})
    CHECK_THROWS_WITH(with_reference(wrong),
                      std::string("m.fmu: modelDescription.xml: valueReference of 'u': found '") + wrong +
                          "'; allowed: a whole number from 0 to 4294967295");
  CHECK_THROWS_WITH(with_reference(""), Contains("found nothing; allowed: a whole number"));
  for (const char* wrong : {"../../m", "/usr/lib/m", "a.b", "9m", "m m"})
    CHECK_THROWS_WITH(
        parse_fmu_description(
            description("2.0", std::string("<CoSimulation modelIdentifier=\"") + wrong + "\"/>"), "m.fmu"),
        Contains(std::string("modelIdentifier: found '") + wrong + "'; allowed: a name of C"));
}

TEST_CASE("variables that are not there or not what the study takes them for are refused", "[fmu]") {
  const FmuDescription fmu = parse_fmu_description(description("2.0", kCoSimulation), "m.fmu");
  CHECK_THROWS_WITH(fmu.variable("w", FmuRole::input, "s.toml:3: plant.fmu.input[0].name"),
                    "s.toml:3: plant.fmu.input[0].name: found 'w', which m.fmu has not; allowed: u");
  CHECK_THROWS_WITH(fmu.variable("y", FmuRole::input, "p"), "p: found 'y' of causality output; allowed: u");
  CHECK_THROWS_WITH(fmu.variable("n", FmuRole::input, "p"), "p: found 'n' of type Integer; allowed: u");
  CHECK_THROWS_WITH(fmu.variable("u", FmuRole::output, "p"), "p: found 'u' of causality input; allowed: y");
  CHECK_THROWS_WITH(fmu.variable("u", FmuRole::parameter, "p"),
                    "p: found 'u' of causality input; allowed: k");
}

}  // namespace
}  // namespace mpm
