#!/usr/bin/env bash
# Runs what is open of a study that has been prepared as jobs of Slurm: an array for the levels of the
# reference, one for the combinations behind it, and the collection behind all (docs/distributed.md).
#
#   scripts/study_slurm.sh STUDY [OPTIONS OF SBATCH]     for example: study_slurm.sh study/ --time=08:00:00
#
# PENT_STUDY names pent-study where it is not in the PATH; it has the same path on the nodes.
set -euo pipefail

# What a job does. Its exit code is that of pent-study.
#
#   --task PROGRAM STUDY FIRST     runs the unit FIRST + the number of the task
#   --collect PROGRAM STUDY
run_job() {
    local words=("$2" -o "$3" --quiet)
    case $1 in
        --task) words+=(--run $(($4 + SLURM_ARRAY_TASK_ID))) ;;
        --collect) words+=(--collect) ;;
    esac
    local is_late=false code=0 child
    # The time limit is near: pent-study stops in order, and goes on in the same job, queued again.
    trap 'is_late=true; kill -TERM "$child"' USR1
    trap 'kill -TERM "$child"' TERM
    "${words[@]}" &
    child=$!
    wait "$child" || code=$?
    if [ "$code" -gt 128 ]; then  # of the wait, which a signal ends
        code=0
        wait "$child" || code=$?
    fi
    if $is_late && [ "$code" -eq 3 ]; then
        echo "study_slurm: stopped at the time limit, queued again"
        scontrol requeue "${SLURM_ARRAY_JOB_ID:-$SLURM_JOB_ID}${SLURM_ARRAY_TASK_ID:+_$SLURM_ARRAY_TASK_ID}"
    fi
    exit "$code"
}

case ${1:-} in
    --task | --collect) run_job "$@" ;;
    -h | --help) sed -n '2,/^[^#]/{/^[^#]/d;s/^# \{0,1\}//p}' "$0"; exit 0 ;;  # without help.sh: it is installed alone
    "" | -*) echo "study_slurm: expected the folder of a study: study_slurm.sh STUDY [OPTIONS OF SBATCH]" >&2; exit 2 ;;
esac

program=${PENT_STUDY:-pent-study}
if ! program=$(command -v "$program"); then
    echo "study_slurm: ${PENT_STUDY:-pent-study} is not there; put it in the PATH, or name it in PENT_STUDY" >&2
    exit 1
fi
if ! command -v sbatch >/dev/null; then
    echo "study_slurm: sbatch is not there; run this where Slurm takes jobs" >&2
    exit 1
fi
units=$("$program" -o "$1" --list-runs)  # says what is wrong with the folder
study=$(cd "$1" && pwd)
shift
threads=$(sed -n 's/^ "threads": \([0-9]*\),$/\1/p' "$study/plan.json")
largest=$(scontrol show config | sed -n 's/^MaxArraySize *= *\([0-9]*\)$/\1/p')
mkdir -p "$study/slurm"

submit() {  # NAME [OPTIONS OF SBATCH] -- ARGUMENTS: prints the number of the job
    local name=$1 options=()
    shift
    while [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    shift
    sbatch --parsable --job-name="$name" --requeue --open-mode=append --cpus-per-task="$threads" \
        --signal=B:USR1@60 "${options[@]}" "${sbatch_options[@]}" "${BASH_SOURCE[0]}" "$@"
}

# Open units of a kind, a line for each array of tasks: FIRST and numbers behind it, as Slurm allows
# no task of a number above MaxArraySize - 1.
arrays_of() {  # KIND
    awk -v kind="$1" -v size="${largest:-1001}" '
        $2 == kind && $4 == "open" {
            first = int($1 / size) * size
            if (first in tasks) tasks[first] = tasks[first] "," ($1 - first)
            else { tasks[first] = $1 - first; order[++count] = first }
        }
        END { for (i = 1; i <= count; ++i) print order[i], tasks[order[i]] }' <<<"$units"
}

jobs=()
submit_units() {  # KIND [OPTIONS OF SBATCH]
    local kind=$1 first tasks job
    shift
    while read -r first tasks; do
        job=$(submit "study-$kind" --array="$tasks" --output="$study/slurm/%x-%A_%a.log" "$@" \
            -- --task "$program" "$study" "$first")
        jobs+=("$job")
        echo "study_slurm: job $job: $kind, tasks $tasks$([ "$first" -eq 0 ] || echo " + $first")"
    done < <(arrays_of "$kind")
}

joined() {
    local IFS=:
    echo "$*"
}

sbatch_options=("$@")
submit_units reference
behind=()
if [ ${#jobs[@]} -gt 0 ]; then
    behind=(--dependency="afterok:$(joined "${jobs[@]}")" --kill-on-invalid-dep=yes)
fi
submit_units combination "${behind[@]}"
behind=()
if [ ${#jobs[@]} -gt 0 ]; then
    behind=(--dependency="afterany:$(joined "${jobs[@]}")")
fi
job=$(submit study-collect --output="$study/slurm/%x-%j.log" "${behind[@]}" -- --collect "$program" "$study")
echo "study_slurm: job $job: collection, into $study"
