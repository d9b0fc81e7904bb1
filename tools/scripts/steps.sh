# SPDX-License-Identifier: MIT
# What ./check and ./demo share; sourced by both. Expects `kName`, the command's name.
# shellcheck shell=bash

say() { printf '%s: %s\n' "$kName" "$*"; }

# step TITLE COMMAND...: announces, runs, and remembers the title for the verdict.
step() {
  current_step=$1
  local start=$SECONDS
  printf '\n=== %s\n' "$1"
  shift
  "$@" || return
  printf '=== done in %d s\n' $((SECONDS - start))
}

# Ends with a verdict however the script ends. Call once, before the first step.
give_verdict_at_exit() {
  current_step="start"
  trap 'verdict $?' EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM
}

verdict() {
  if [[ $1 -eq 0 ]]; then
    printf '\n%s: PASSED in %d s%s\n' "$kName" "$SECONDS" "${verdict_note:+; $verdict_note}"
  else
    printf '\n%s: FAILED in step "%s" after %d s\n' "$kName" "$current_step" "$SECONDS"
  fi
  exit "$1"
}

# Compile jobs at once: a core each, but not more than memory allows (Eigen and GoogleTest take
# up to 1.5 GB a file).
build_jobs() {
  local cores memory_jobs
  cores=$(nproc)
  memory_jobs=$(awk '/^MemAvailable:/ {print int($2 / 1572864)}' /proc/meminfo)
  ((memory_jobs < 1)) && memory_jobs=1
  echo $((cores < memory_jobs ? cores : memory_jobs))
}

# build PRESET [TARGET...]: configures and builds.
build() {
  local preset=$1
  shift
  # Configuring prints pages that nobody reads unless it fails.
  local log=build/$preset-configure.log
  mkdir -p build
  if ! cmake --preset "$preset" >"$log" 2>&1; then
    cat "$log"
    return 1
  fi
  # On a terminal Ninja counts in place.
  if [[ -t 1 ]]; then
    cmake --build --preset "$preset" --parallel "$(build_jobs)" ${1:+--target "$@"}
  else
    cmake --build --preset "$preset" --parallel "$(build_jobs)" ${1:+--target "$@"} | count_in_tenths
  fi
}

# For logs: one line for each tenth, and whatever is no count, such as an error and the command that
# led to it.
count_in_tenths() {
  awk '/^\[[0-9]+\/[0-9]+\] / {
         split(substr($1, 2), count, /[\/\]]/)
         tenth = int(10 * count[1] / count[2])
         if (tenth > shown) printf "built %d of %d\n", count[1], count[2]
         shown = tenth
         fflush()
         next
       }
       {print; fflush()}'
}
