#pragma once

/// What is written for any dimension is built for these: macro(3) macro(4). With PENT_ONLY_4D, as
/// the playground of the page is, for the last alone.
#ifdef PENT_ONLY_4D
#define PENT_FOR_EACH_DIMENSION(macro) macro(4)
#else
#define PENT_FOR_EACH_DIMENSION(macro) macro(3) macro(4)
#endif
