"""Simulates the messages of MPI ranks: at how many ranks is rank 0 the limit, and how does the chunk size move that?

    /usr/bin/python3 studies/cluster/simulate_ranks.py [--costs DIR] [--out DIR] [--figure FILE]

DIR holds the files of `rank_costs`: times of single runs (run_times.csv), and rank 0's costs of a message and of a row
(costs.csv). Every rank has one thread and four chunks in store beside the current one. When it begins a chunk it sends its
finished rows and asks for another, as montecarlo/engine/mpi does. Rank 0 handles messages one after the other. MPI's own
time, latency and bandwidth are those of a usual cluster; options change them. Prints a table, writes simulation.csv, draws a chart.
"""

import argparse
import csv
import heapq
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "plots"))

RANKS = (64, 1024, 16384)
CHUNKS = (1, 4, 32, 256)
IN_STORE = 4  # chunks that a rank has beside the current one


def read_costs(folder):
    with open(folder / "costs.csv", newline="", encoding="utf-8") as file:
        costs = {row["name"]: float(row["value"]) for row in csv.DictReader(file)}
    with open(folder / "run_times.csv", newline="", encoding="utf-8") as file:
        times = [float(row["seconds"]) / costs["lanes_speedup"] for row in csv.DictReader(file)]
    return costs, times


class Job:
    """One job: `chunks` chunks of `size` runs, `slower` times as slow as those that were measured."""

    def __init__(self, costs, times, ranks, size, slower, chunks, latency, bandwidth, seed=1):
        self.costs, self.ranks, self.size = costs, ranks, size
        self.left = chunks
        self.way = latency + size * costs["row_bytes"] / bandwidth
        self.latency = latency
        chance = random.Random(seed)
        self.pool = [slower * sum(chance.choices(times, k=size)) for _ in range(4096)]  # what a chunk takes
        self.chance = chance
        self.cost_of = {rows: costs["message_s"] + rows * costs["row_s"] for rows in (0, size)}

    def run(self):
        """Returns the efficiency (share of the ranks' time spent on runs) and the busy share of rank 0."""
        store, waits = [0] * self.ranks, [True] * self.ranks
        events, order, free, busy, worked = [], 0, 0.0, 0.0, 0.0

        def tell(at, kind, rank, rows):
            nonlocal order
            order += 1
            heapq.heappush(events, (at, order, kind, rank, rows))

        for rank in range(self.ranks):
            for _ in range(IN_STORE + 1):
                tell(self.latency, "asked", rank, 0)
        end = 0.0
        while events:
            now, _, kind, rank, rows = heapq.heappop(events)
            if kind == "asked":  # at rank 0, which takes messages in as they come
                cost = self.cost_of[rows]
                free = max(free, now) + cost
                busy += cost
                end = max(end, free)
                if self.left > 0:
                    self.left -= 1
                    tell(free + self.latency, "chunk", rank, 0)
            else:
                if kind == "chunk":
                    store[rank] += 1
                    if not waits[rank]:
                        continue
                else:  # a chunk is done: its rows go out, and ask for another
                    tell(now + self.way, "asked", rank, self.size)
                if store[rank] > 0:
                    store[rank] -= 1
                    waits[rank] = False
                    took = self.chance.choice(self.pool)
                    worked += took
                    tell(now + took, "done", rank, 0)
                else:
                    waits[rank] = True
        return worked / (self.ranks * end), busy / end


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--costs", type=pathlib.Path, default=pathlib.Path("results/rank_costs"))
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("results/rank_costs"))
    parser.add_argument("--figure", type=pathlib.Path, default=pathlib.Path("studies/figures/ranks.png"))
    parser.add_argument("--latency", type=float, default=2e-6, help="of a message, s")
    parser.add_argument("--bandwidth", type=float, default=1e10, help="bytes a second")
    parser.add_argument("--mpi", type=float, default=3e-6, help="rank 0's time in MPI for a message and its answer, s")
    parser.add_argument("--chunks-each", type=int, default=20, help="chunks that each rank makes")
    options = parser.parse_args()
    costs, times = read_costs(options.costs)
    costs["message_s"] += options.mpi
    run = sum(times) / len(times)
    rows = []
    print(f"a run takes {1e6 * run:.1f} us, the slowest of {len(times)} {max(times) / run:.1f} times as long; "
          f"rank 0: {1e6 * costs['message_s']:.2f} us a message, {1e6 * costs['row_s']:.2f} us a row")
    print(f"{'a run':>9} {'chunk':>6} {'limit':>8}   " + "   ".join(f"{ranks:>6} ranks" for ranks in RANKS))
    for slower in (1, 10, 100, 1000):
        for size in CHUNKS:
            limit = slower * run * size / (costs["message_s"] + size * costs["row_s"])
            cells = []
            for ranks in RANKS:
                job = Job(costs, times, ranks, size, slower, ranks * options.chunks_each, options.latency, options.bandwidth)
                efficiency, busy = job.run()
                rows.append({"run_s": slower * run, "chunk": size, "ranks": ranks, "efficiency": efficiency,
                             "rank_0_busy": busy, "limit_ranks": limit})
                cells.append(f"{100 * efficiency:5.1f} % {'*' if busy > 0.95 else ' '}   ")
            print(f"{1e3 * slower * run:6.2f} ms {size:6d} {limit:8.0f}   " + "  ".join(cells))
    print("* rank 0 is busy more than 95 % of the time; limit: the ranks at which it would be all the time")
    options.out.mkdir(parents=True, exist_ok=True)
    with open(options.out / "simulation.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    draw(rows, options.figure)


def draw(rows, figure_file):
    from charts import plt, TAB10

    def distinct(key):
        return list(dict.fromkeys(row[key] for row in rows))

    runs = distinct("run_s")
    figure, panels = plt.subplots(1, len(runs), figsize=(3.1 * len(runs), 3.3), sharey=True)
    for panel, run in zip(panels, runs):
        for size, colour, marker in zip(distinct("chunk"), TAB10, "osD^"):
            those = [row for row in rows if row["run_s"] == run and row["chunk"] == size]
            panel.plot([row["ranks"] for row in those], [100 * row["efficiency"] for row in those], marker=marker,
                       color=colour, label="1 run a chunk" if size == 1 else f"{size} runs a chunk")
        limit = max(row["limit_ranks"] for row in rows if row["run_s"] == run)
        panel.axvline(limit, color="0.5", linestyle=":", linewidth=1)
        panel.set_xscale("log", base=2)
        panel.set_title(f"{1e3 * run:.3g} ms a run", fontsize=10)
        panel.set_xlabel("ranks of one thread")
        panel.set_xlim(32, 32768)
        panel.grid(alpha=0.3)
    panels[0].set_ylabel("efficiency, %")
    panels[0].set_ylim(0, 104)
    panels[0].legend(fontsize=7, loc="upper right")
    figure.tight_layout()
    figure.savefig(figure_file, dpi=110)
    print(figure_file)


if __name__ == "__main__":
    main()
