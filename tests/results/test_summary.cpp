#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "analysis/study_aggregate.hpp"
#include "campaign_sample.hpp"
#include "results/summary.hpp"

namespace {

using namespace mpm;

TEST_CASE("summary: text names the failures and the reported values, JSON has the numbers of the aggregate") {
  const Campaign campaign = campaign_sample();
  const std::string text = summary_text(campaign, "out.h5");
  CHECK(text.find("1 experiments failed") != std::string::npos);
  CHECK(text.find("signal 9") != std::string::npos);
  CHECK(text.find("reported") != std::string::npos);
  CHECK(text.find("Ivar of the nominal loop") != std::string::npos);

  const nlohmann::json json = nlohmann::json::parse(summary_json(campaign));
  const auto values = named_values(aggregate(campaign.study, campaign.records));
  REQUIRE(json["aggregates"].size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(json["aggregates"][i]["name"] == values[i].name);
    if (std::isfinite(values[i].value))
      CHECK(json["aggregates"][i]["value"].get<double>() == values[i].value);
    else
      CHECK(json["aggregates"][i]["value"].is_null());
  }
  CHECK(json["aggregates"][0]["reported"] == 0.04);
}

}  // namespace
