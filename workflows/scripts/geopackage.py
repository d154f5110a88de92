"""Trees as a GeoPackage (OGC 12-128r17), which maps' programs open.

It is a SQLite file with five tables, and Python has SQLite; the libraries that write it bring all of GDAL, 60 MB.
"""
import os
import sqlite3
import struct
from pathlib import Path

UNKNOWN = -1  # "undefined Cartesian", which the standard asks for
SYSTEMS = [
    ("Undefined Cartesian SRS", -1, "NONE", -1, "undefined"),
    ("Undefined geographic SRS", 0, "NONE", 0, "undefined"),
    (
        "WGS 84 geodetic",
        4326,
        "EPSG",
        4326,
        'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
        'UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]',
    ),
]
TABLES = """
PRAGMA application_id = 1196444487;
PRAGMA user_version = 10300;
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY,
    organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
    description TEXT DEFAULT '', last_change DATETIME NOT NULL, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE,
    max_y DOUBLE, srs_id INTEGER REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL,
    geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
    PRIMARY KEY (table_name, column_name), FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
    FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
"""
# The day that the file says it was changed on is no part of what it says of trees: same trees, same bytes.
NO_DAY = "2000-01-01T00:00:00.000Z"


def point(place, system):
    """A header without an envelope, and a point with a height."""
    return b"GP\0\x01" + struct.pack("<i", system) + struct.pack("<BI3d", 1, 1001, *place)


def write(path, columns, rows, epsg):
    """columns: (name, SQL's type). rows: (place or nothing, values)."""
    part = Path(f"{path}.part")
    part.unlink(missing_ok=True)
    base = sqlite3.connect(part)
    with base:
        base.executescript(TABLES)
        base.executemany("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, NULL)", SYSTEMS)
        system = epsg or UNKNOWN
        if epsg and epsg != 4326:
            base.execute(
                "INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, 'EPSG', ?, 'undefined', NULL)",
                (f"EPSG:{epsg}", epsg, epsg),
            )
        places = [place for place, _ in rows if place]
        box = [f(p[axis] for p in places) if places else None for f in (min, max) for axis in (0, 1)]
        base.execute(
            "INSERT INTO gpkg_contents VALUES ('trees', 'features', 'trees', 'Trees of scans', ?, ?, ?, ?, ?, ?)",
            (NO_DAY, *box, system),
        )
        base.execute("INSERT INTO gpkg_geometry_columns VALUES ('trees', 'geom', 'POINT', ?, 1, 0)", (system,))
        named = ", ".join(f'"{name}" {kind}' for name, kind in columns)
        base.execute(f"CREATE TABLE trees (fid INTEGER PRIMARY KEY AUTOINCREMENT, geom POINT, {named})")
        marks = ", ".join("?" * (len(columns) + 1))
        names = ", ".join(f'"{name}"' for name, _ in columns)
        base.executemany(
            f"INSERT INTO trees (geom, {names}) VALUES ({marks})",
            [(point(place, system) if place else None, *values) for place, values in rows],
        )
    base.close()
    os.replace(part, path)
