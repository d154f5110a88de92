"""python3 -m treerec MODEL.glb OUT.usdz"""

import sys

from . import Error, usd

if len(sys.argv) != 3:
    sys.exit("Usage: python3 -m treerec MODEL.glb OUT.usdz (or .usd, .usda, .usdc)")
try:
    usd.convert(sys.argv[1], sys.argv[2])
except Error as error:
    sys.exit(str(error))
