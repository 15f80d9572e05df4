#!/bin/bash
# toolchains/packaging/make_jar.sh LCM_GEN JAVAC JAR LCM_JAR OUTPUT TYPE.lcm...
# Java classes of the message types as one jar; the same bytes every time.
set -euo pipefail
generator=$1 compiler=$2 jar=$3 lcm=$4 output=$5
shift 5
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$generator" --java --jpath "$scratch/java" "$@"
find "$scratch/java" -name '*.java' | sort >"$scratch/sources"
"$compiler" --release 11 -nowarn -cp "$lcm" -d "$scratch/classes" "@$scratch/sources"
rm -f "$output"
date=$(date -u -d "@${SOURCE_DATE_EPOCH:-1700000000}" +%Y-%m-%dT%H:%M:%SZ)
(cd "$scratch/classes" && find . -name '*.class' -printf '%P\n' | LC_ALL=C sort >../names && "$jar" --create --no-manifest --date "$date" --file "$output" "@../names")
