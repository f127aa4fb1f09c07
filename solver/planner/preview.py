"""Method `preview`: attitude one sample at a time, with 0 to 2 s of known or predicted future.

The step is the exact one inside a box that always can brake (`solver.step`, `solver.limits`,
`solver.tracking`). What is free, the place on the self-motion, follows a plan that is made again
every few tens of milliseconds over the horizon: the known preview, then the attitude predicted at the
present body rate. A re-plan is a frozen, picklable job that may run in any thread or process.

Source: METHODS section 9.
"""
