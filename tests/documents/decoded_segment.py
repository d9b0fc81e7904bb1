# SPDX-License-Identifier: MIT
"""`segment`: the first of out/column.json as a `segment_t` that was encoded and decoded again, by
the types that lcm-gen made beside it."""
import json

import camway

_shown = json.load(open("out/column.json"))["segments"][0]
_sent = camway.segment_t()
_sent.t0_s, _sent.t1_s = _shown["t0"], _shown["t1"]
_sent.position_m, _sent.orientation_wxyz = _shown["position"], _shown["orientation"]
segment = camway.segment_t.decode(_sent.encode())
