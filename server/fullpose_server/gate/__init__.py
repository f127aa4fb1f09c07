"""The process in front of the server: it accepts every connection, serves stop and E-stop, and passes on the rest.

Decision 0023 tells why, with what was measured. The server may be busy, hung, out of disk or out of files: what is here
shares no event loop, thread pool, database or descriptor table with it.
"""
