#!/usr/bin/env bash
# Kills pent-sim at random moments, resumes it, and compares every frame with an undisturbed run: five kills
# a round. The tests do one round. Then stops short runs at each of ten steps, under every combination of
# integrator, model of contact, friction, self-contact, sleep, elements and energy: some minutes.
#
#   scripts/faults.sh [ROUNDS]      default: 20, which is 100 kills
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset dev >/dev/null
cmake --build --preset dev --target faults_test resume_table_test pent-sim
build/dev/tests/apps/faults_test --gtest_filter='Faults.RunKilled*' --gtest_shuffle \
    --gtest_repeat="${1:-20}" --gtest_fail_fast --gtest_brief=1
echo "faults: $((5 * ${1:-20})) kills, every run the same to the byte"
build/dev/tests/runs/resume_table_test --gtest_also_run_disabled_tests --gtest_filter='*EveryCombination*' \
    --gtest_brief=1
echo "faults: every combination of settings stopped at each of ten steps, every run the same to the byte"
