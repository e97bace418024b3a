#!/usr/bin/env bash
# Whether two builds of the trainer diagnose alike: JSON to the byte but for the seconds, and the improved image to the byte.
#
# usage: tests/same-diagnosis.sh OLD_TRAINER NEW_TRAINER [FOLDER]
#
# Diagnoses the fixtures, a simulated recording of every effect, pairs of recording and simulation or model, and, where the
# folder is there, other people's recordings in ../shared/recordings. FOLDER keeps the answers (a temporary one without); the
# answers of a build that are there already are not made again. Exit 1 where any answer differs.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '4s/^# //p' "$0"; exit 2; }
old=$(realpath "$1") new=$(realpath "$2")
home=$(realpath "$(dirname "$0")/..")
folder=${3:-$(mktemp -d)}
mkdir -p "$folder/recordings"
readonly effects=(stribeck viscous_nonlinearity direction_asymmetry temperature warm_up load_friction drive_backdrive slow_drift
    presliding frictional_lag dwell_breakaway position_ripple kinematic_error position_friction gravity_error inertia_error
    torque_scale torque_offset spring coupling saturation contact transient_event recurrent_fault backlash elasticity
    windup_hysteresis time_misalignment quantisation unit_or_sign)

# Recordings are made by the old build alone, so that both builds read the same.
printf '[plant]\nlink_encoder = true\n' >"$folder/recordings/joint.toml"
simulate() {
    local name=$1
    shift
    [ -e "$folder/recordings/$name.csv" ] ||
        "$old" simulate "$@" -o "$folder/recordings/$name.csv" --quiet
}
for effect in "${effects[@]}"; do
    simulate "$effect" "$folder/recordings/joint.toml" --effect "$effect=1" --duration 36 --seed 11
done
simulate clean "$folder/recordings/joint.toml" --duration 36 --seed 12
simulate coarse "$folder/recordings/joint.toml" --duration 36 --seed 13 --noise coarse_encoder --effect stribeck=0.5
simulate pair "$folder/recordings/joint.toml" --duration 36 --seed 14 --effect load_friction=1 --effect position_ripple=1
simulate elbow "$home/fixtures/elbow.toml" --duration 36 --seed 7 --effect presliding=1

# Every case: a name and the arguments of `diagnose`.
cases() {
    local path
    for path in elbow stribeck elbow-test; do echo "fixture-$path $home/fixtures/$path.csv"; done
    for path in "${effects[@]}" clean coarse pair; do
        echo "$path $folder/recordings/$path.csv --joint $folder/recordings/joint.toml"
    done
    echo "elbow $folder/recordings/elbow.csv --joint $home/fixtures/elbow.toml"
    echo "spline $folder/recordings/elbow.csv --joint $home/fixtures/elbow.toml --base spline"
    echo "tail $folder/recordings/pair.csv --lock tail:0.3"
    echo "unlocked $folder/recordings/pair.csv --lock none"
    echo "simulation $folder/recordings/pair.csv --simulation $folder/recordings/clean.csv"
    echo "holding-simulation $folder/recordings/pair.csv --simulation $folder/recordings/position_ripple.csv"
    echo "model $folder/recordings/elbow.csv --joint $home/fixtures/elbow.toml --model $home/fixtures/elbow.frk"
    echo "several $folder/recordings/clean.csv $folder/recordings/stribeck.csv"
    [ -d "$home/../shared/recordings" ] || { echo "no ../shared/recordings: skipped" >&2; return; }
    local shared
    shared=$(realpath "$home/../shared/recordings")
    echo "emps $shared/emps/train.csv"
    echo "odrive $shared/odrive_cogging/slow2-nocomp_0.csv --joint $folder/recordings/odrive.toml"
    echo "tribometer $shared/tribometer/reciprocating.csv"
    for path in 1-A 2-B 3-C 4-C 5-A 6-B; do echo "kr300-$path $shared/kr300/axis$path.csv"; done
}
printf '[drive]\ncounts_per_turn = 8192\n' >"$folder/recordings/odrive.toml"

# Answers of one build, in the folder of its checksum.
answers() {
    local trainer=$1 into name arguments
    into="$folder/$(sha256sum "$trainer" | cut -c 1-16)"
    mkdir -p "$into"
    cases | while read -r name arguments; do
        [ -e "$into/$name.json" ] && continue
        # shellcheck disable=SC2086 # the arguments are words
        "$trainer" diagnose $arguments --json "$into/$name.raw" -o "$into/$name.frk" --advise "$into/$name.csv" --quiet \
            >/dev/null 2>"$into/$name.err" || echo "exit $?" >>"$into/$name.err"
        [ -e "$into/$name.raw" ] || echo '{}' >"$into/$name.raw"
        sed -E 's/"seconds":[0-9.e-]+/"seconds":0/; s/"configuration":\{("[^"]*":\{[^}]*\},?)*\},?//' "$into/$name.raw" >"$into/$name.json"
        rm "$into/$name.raw"
    done
    echo "$into"
}
before=$(answers "$old")
after=$(answers "$new")
differing=0 compared=0
for answer in "$before"/*; do
    name=$(basename "$answer")
    compared=$((compared + 1))
    cmp -s "$answer" "$after/$name" || { echo "differs: $name"; differing=$((differing + 1)); }
done
echo "$compared files of $(ls "$before"/*.json | wc -l) diagnoses compared, $differing differ ($folder)"
[ "$differing" -eq 0 ]
