#pragma once

/// What is written for any dimension is built for these: macro(3, ...) and macro(4, ...). With
/// PENT_ONLY_4D, as the playground of the page is built, for the last alone.
#ifdef PENT_ONLY_4D
#define PENT_FOR_EACH_DIMENSION(macro, ...) macro(4 __VA_OPT__(, ) __VA_ARGS__)
#else
#define PENT_FOR_EACH_DIMENSION(macro, ...) \
    macro(3 __VA_OPT__(, ) __VA_ARGS__) macro(4 __VA_OPT__(, ) __VA_ARGS__)
#endif
