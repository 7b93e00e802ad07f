#!/bin/sh
# Run a study on machines that are reached by ssh:
#
#   sh ssh.sh STUDY.toml HOST [HOST ...]
#
# A host may come several times, once for each worker; "localhost" is this machine, without ssh.
# Every machine has the same trundle, with the extra "cluster", in the same folder; ssh asks for
# no password. Everything that is started ends with this script. What reaches the scheduler's port
# may run anything: keep it inside a network that you trust.
#
#   TRUNDLE_BIN      folder of the commands trundle and dask   (that of trundle on the path)
#   SCHEDULER_HOST   name by which the others know this machine   (hostname)
#   SCHEDULER_PORT   (8786)
#   WORKER_THREADS   processors for each worker   (1)
#   TRUNDLE_OPTIONS  further options of trundle run, such as "--out DIR --yes"
set -eu

if [ $# -lt 2 ]; then
    echo "usage: sh ssh.sh STUDY.toml HOST [HOST ...]" >&2
    exit 2
fi
study=$1
shift
bin=${TRUNDLE_BIN:-$(dirname "$(command -v trundle)")}
host=${SCHEDULER_HOST:-$(hostname)}
port=${SCHEDULER_PORT:-8786}
threads=${WORKER_THREADS:-1}
address=tcp://$host:$port
export DASK_LOGGING__DISTRIBUTED=error  # what matters of workers is told by the run

started=""
stop() {
    "$bin/python" - "$address" >/dev/null 2>&1 <<'PYTHON' || true
import sys

from distributed import Client

Client(sys.argv[1], timeout=10).shutdown()  # workers end with their scheduler
PYTHON
    for process in $started; do
        kill "$process" 2>/dev/null || true
    done
    wait 2>/dev/null || true
}
trap stop EXIT
trap 'exit 130' INT TERM

"$bin/dask" scheduler --host "$host" --port "$port" --no-dashboard &
started=$!

# one task at a time in a worker, which may use so many processors for it
threads_of="TRUNDLE_THREADS=$threads OMP_NUM_THREADS=$threads OPENBLAS_NUM_THREADS=$threads"
worker="env DASK_LOGGING__DISTRIBUTED=error $threads_of MKL_NUM_THREADS=$threads \
    $bin/dask worker $address --nthreads 1 --no-dashboard --death-timeout 60"
for one in "$@"; do
    if [ "$one" = localhost ]; then
        $worker &
    else
        ssh -o BatchMode=yes -tt "$one" "$worker" </dev/null &
    fi
    started="$started $!"
done

"$bin/python" - "$address" $# <<'PYTHON'
import sys

from distributed import Client

with Client(sys.argv[1], timeout=60) as client:
    client.wait_for_workers(int(sys.argv[2]), timeout=120)
PYTHON

# shellcheck disable=SC2086 # options are words
"$bin/trundle" run "$study" --scheduler "$address" ${TRUNDLE_OPTIONS:-}
