"""The nominal wing with weaker springs, then a thousand dispersed wings: which hinge latches last?"""
import numpy as np
import wingspread

for scale in (1.0, 0.8):
    outcome, path = wingspread.simulate("studies/scenes/three_panel_flight.json",
                                        set={"hinges.*.spring.scale": scale}, dt=0.01)
    print(f"springs × {scale}: last latch {outcome['latches'][-1]['time']:.3f} s,"
          f" root turned {np.degrees(np.ptp(path['root.angle'])):.1f} deg")

runs = wingspread.run("studies/campaigns/seed.json", runs=1000)
last = [order.split(">")[-1] for order in runs["latch_order"]]
for hinge in ("mid", "tip"):
    print(f"{hinge} latches last in {last.count(hinge)} of {len(last)} runs")
print(f"99 % of root moments are below {np.quantile(runs['root.peak_moment'], 0.99):.1f} N·m")
