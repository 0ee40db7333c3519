#include <string>

#include <catch2/catch.hpp>

#include "results/report/change_report.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

const Campaign& first_run() {
  static const Campaign campaign = campaign_sample();
  return campaign;
}

TEST_CASE("change report: nothing changed between an archive and itself") {
  const std::string page = change_html(first_run(), "x/a.h5", first_run(), "x/b.h5");
  CHECK_THAT(page, Contains("<strong>Nothing changed.</strong>") &&
                       Contains("No key of the study or of a method from outside differs"));
  CHECK_THAT(page, Contains("no number of a method in both archives changed in any common experiment"));
  CHECK(page == change_html(first_run(), "other/a.h5", first_run(), "b.h5"));
}

TEST_CASE("change report: archives of the same name are told apart by their paths") {
  CHECK_THAT(change_html(first_run(), "old/out.h5", first_run(), "new/out.h5"),
             Contains("<code>old/out.h5</code>") && Contains("<code>new/out.h5</code>"));
}

TEST_CASE("change report: a verdict that is right no more stands there with both commands") {
  Campaign now = first_run();
  // Flags what was not flagged and the reverse, so that its answer to both truths is the opposite.
  AssessmentRecord& said = now.records[6].assessments[chain_place(now)];
  REQUIRE(said.answered());
  said.flagged = !said.flagged;
  const std::string page = change_html(first_run(), "a b.h5", now, "<i>.h5");
  CHECK_THAT(page, Contains("<code>mpmbench replay a b.h5 6</code>") &&
                       Contains("<code>mpmbench replay &lt;i&gt;.h5 6</code>") && !Contains("<i>"));
  CHECK_THAT(page, Contains("flag, fault") && !Contains("<strong>Nothing changed.</strong>"));
  CHECK_THAT(page, !Contains("mpmbench replay a b.h5 5<"));
  CHECK((change_html(streamed_from(first_run()), "a b.h5", streamed_from(now), "<i>.h5") == page));
}

TEST_CASE("change report: another seed, other methods and none in common are told") {
  Campaign now = first_run();
  now.study.seed = 5;
  const std::string page = change_html(first_run(), "a.h5", now, "b.h5");
  CHECK_THAT(page, Contains("Compared as unrelated runs") &&
                       Contains("the seeds differ, 12345678901234567890 and 5"));
  CHECK((change_html(streamed_from(first_run()), "a.h5", streamed_from(now), "b.h5") == page));
  CHECK_THAT(page, Contains("Left out: the runs are not paired"));

  Campaign chain = first_run(), others = first_run();
  remove_methods(chain, [](const std::string& name) { return name != "botelho"; });
  remove_methods(others, [](const std::string& name) { return name == "botelho"; });
  CHECK_THAT(change_html(chain, "a.h5", others, "b.h5"),
             Contains("The archives have no method of assessment in common"));
}

}  // namespace
