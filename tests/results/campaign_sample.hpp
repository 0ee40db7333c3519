#pragma once

#include "results/archive/campaign.hpp"

/// A short campaign of the chapter 6 study, assessed by the chain, with made-up records beside it: an
/// infeasible and a failed experiment, NaN, infinity, a message that is not ASCII, and answers of every other
/// method.
mpm::Campaign campaign_sample();
