#pragma once

/// The dimensions that what is written for all is built for: calls macro(3) and macro(4), of which a
/// program for one dimension alone (PENT_ONLY_4D, as the playground is) leaves out the first.
#ifdef PENT_ONLY_4D
#define PENT_FOR_EACH_DIMENSION(macro) macro(4)
#else
#define PENT_FOR_EACH_DIMENSION(macro) macro(3) macro(4)
#endif
