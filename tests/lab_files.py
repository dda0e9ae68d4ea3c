"""Small files in the formats of laboratories, all of the same invented measurement.

Three sweeps of four frequencies, E' and E'' in MPa. The layouts follow the
instruments' exports; names and numbers are made up.
"""

import json

import numpy as np

CELSIUS = (-40.0, -30.0, -20.0)
HERTZ = (0.1, 1.0, 10.0, 100.0)
STORAGE = np.array([[812.4, 905.1, 1004.7, 1101.9], [301.2, 402.5, 508.8, 640.3],
                    [52.17, 88.04, 151.6, 240.9]])  # fmt: skip
LOSS = np.array([[122.6, 118.3, 109.9, 96.21], [140.8, 151.3, 158.2, 150.4],
                 [18.44, 36.91, 64.05, 98.73]])  # fmt: skip

# what every reader must find
TEMPERATURE = np.repeat(np.array(CELSIUS) + 273.15, len(HERTZ))
OMEGA = np.tile(2 * np.pi * np.array(HERTZ), len(CELSIUS))
PASCAL = STORAGE.ravel() * 1e6, LOSS.ravel() * 1e6


def rows():
    """Return T [C], f [Hz], E' [MPa], E'' [MPa], point by point."""
    return [
        (celsius, hertz, STORAGE[i, j], LOSS[i, j])
        for i, celsius in enumerate(CELSIUS)
        for j, hertz in enumerate(HERTZ)
    ]


def plain(separator=",", decimal=".", units="Hz, MPa, MPa, C", names="f, E', E'', T"):
    lines = [separator.join(names.split(", ")), separator.join(units.split(", "))]
    lines += [
        separator.join(f"{x:.8g}" for x in (f, storage, loss, T)).replace(".", decimal)
        for T, f, storage, loss in rows()
    ]
    return ("\n".join(lines) + "\n").encode()


def pyvisco():
    lines = ["f,E_stor,E_loss,T,Set", "Hz, MPa, MPa, C, -"]
    lines += [
        f"{f:.8g},{storage:.8g},{loss:.8g},{T:.8g},{CELSIUS.index(T)}"
        for T, f, storage, loss in rows()
    ]
    return b"\xef\xbb\xbf" + ("\r\n".join(lines) + "\r\n").encode()


def trios_lims():
    """A header, then steps whose rows are named; tabs."""
    lines = [
        "Filename\tpdms 3.tri",
        "Instrument name\tDMA850",
        "Geometry name\tFilm tension",
        "Sample name\tsilicone",
        "",
    ]
    for i, celsius in enumerate(CELSIUS):
        lines += [
            "[step]",
            f"Step name\tFrequency sweep ({celsius:g} °C)",
            f"Number of points\t{len(HERTZ)}",
            "Variables\tTime\tTemperature\tFrequency\tStorage modulus\tLoss modulus\tTan(delta)",
            "\ts\t°C\tHz\tMPa\tMPa\t",
        ]
        for j, hertz in enumerate(HERTZ):
            storage, loss = STORAGE[i, j], LOSS[i, j]
            lines.append(
                f"data point {j + 1}\t{60.0 * j:g}\t{celsius:g}\t{hertz:g}\t{storage:.8g}\t"
                f"{loss:.8g}\t{loss / storage:.5f}"
            )
        lines.append("")
    return ("\r\n".join(lines) + "\r\n").encode("utf-8")


def trios_csv():
    """A header, then steps with plain tables; commas."""
    lines = ["Filename,pdms 3.tri", "Geometry name,Dual cantilever", ""]
    for i, celsius in enumerate(CELSIUS):
        lines += [
            "[step]",
            f"Frequency sweep - {i + 1}",
            "Angular frequency,Step time,Temperature,Storage modulus,Loss modulus,Tan(delta)",
            "rad/s,s,°C,Pa,Pa,",
        ]
        for j, hertz in enumerate(HERTZ):
            storage, loss = 1e6 * STORAGE[i, j], 1e6 * LOSS[i, j]
            lines.append(
                f"{2 * np.pi * hertz:.12g},{60.0 * j:g},{celsius:g},{storage:.8g},{loss:.8g},"
                f"{loss / storage:.5f}"
            )
        lines.append("")
    return ("\n".join(lines) + "\n").encode("latin-1")


_ENGLISH = (
    ("Project:", "Test:", "Result:", "Interval and data points:", "Interval data:"),
    ("Point No.", "Temperature", "Frequency", "Tensile Storage Modulus", "Tensile Loss Modulus",
     "Loss Factor", "Status"),
)  # fmt: skip
_GERMAN = (
    ("Projekt:", "Test:", "Ergebnis:", "Abschnitt und Messpunkte:", "Abschnittsdaten:"),
    ("Meßpkt.", "Temperatur", "Frequenz", "Zug-Speichermodul", "Zug-Verlustmodul",
     "Verlustfaktor", "Status"),
)  # fmt: skip


def rheocompass(german=True, separator="\t", encoding="utf-16"):
    """Intervals with their counts, an empty first column, units in brackets below a blank row."""
    labels, names = _GERMAN if german else _ENGLISH
    decimal = "," if german else "."
    lines = [f"{labels[0]}{separator}silicone", f"{labels[1]}{separator}film 1", ""]
    for i, celsius in enumerate(CELSIUS):
        lines += [
            f"{labels[2]}{separator}sweep {i + 1}",
            "",
            separator.join((labels[3], str(i + 1), str(len(HERTZ)))),
            separator.join((labels[4], *names)),
            separator * len(names),
            separator.join(("", "", "[°C]", "[Hz]", "[MPa]", "[MPa]", "[1]", "")),
        ]
        for j, hertz in enumerate(HERTZ):
            storage, loss = STORAGE[i, j], LOSS[i, j]
            numbers = (
                f"{celsius:.2f}", f"{hertz:.6g}", f"{storage:.6g}", f"{loss:.6g}",
                f"{loss / storage:.4f}",
            )  # fmt: skip
            cells = [number.replace(".", decimal) for number in numbers]
            lines.append(separator.join(("", str(j + 1), *cells, "DY_auto")))
        lines.append("")
    return ("\r\n".join(lines) + "\r\n").encode(encoding)


def reptate(celsius=-20.0, headings=True):
    """One temperature, shear, in rad/s and Pa."""
    i = CELSIUS.index(celsius)
    lines = [f"T={celsius:g};Mw=94.9;chem=PDMS;label=film 1;"]
    if headings:
        lines += ["Freq\tG'\tG\"\tTemp", "rad/s\tPa\tPa\t°C"]
    for j, hertz in enumerate(HERTZ):
        cells = [f"{2 * np.pi * hertz:.12g}", f"{1e6 * STORAGE[i, j]:.8g}"]
        cells += [f"{1e6 * LOSS[i, j]:.8g}"] + [f"{celsius:g}"] * headings
        lines.append("\t".join(cells))
    return ("\n".join(lines) + "\n").encode()


# what TRIOS adds when all variables are exported: names that hold others, and doubles
_ALL = {
    "Run time": ("s", lambda f, s, l: 60.0),
    "Angular frequency": ("rad/s", lambda f, s, l: 2 * np.pi * f),
    "Oscillation stress": ("MPa", lambda f, s, l: 0.01 * s),
    "Stress": ("MPa", lambda f, s, l: -1.7e-6),
    "Stress (step)": ("MPa", lambda f, s, l: -1.9e-6),
    "Complex viscosity": ("MPa.s", lambda f, s, l: np.hypot(s, l) / (2 * np.pi * f)),
    "Phase angle": ("°", lambda f, s, l: np.degrees(np.arctan2(l, s))),
    "Status bits": ("", lambda f, s, l: "0xB6453"),
    "Frequency": ("Hz", lambda f, s, l: f),
    "Tan(delta)": ("", lambda f, s, l: l / s),
    "Complex modulus": ("MPa", lambda f, s, l: np.hypot(s, l)),
    "G*/sin(delta)": ("kPa", lambda f, s, l: 1e3 * np.hypot(s, l) ** 2 / l),
    "G*.sin(delta)": ("kPa", lambda f, s, l: 1e3 * l),
    "Storage modulus": ("MPa", lambda f, s, l: s),
    "Loss modulus": ("MPa", lambda f, s, l: l),
}


def _written(value):
    return value if isinstance(value, str) else f"{value:.12g}"


def trios_all():
    """The same with all variables, as exported for laboratory systems."""
    lines = ["[Version]", "[Geometry]", "Geometry name\tFilm tension", ""]
    for i, celsius in enumerate(CELSIUS):
        lines += [
            "[Step]",
            f"Step name\tFrequency sweep ({celsius:.1f} °C)",
            f"Number of points\t{len(HERTZ)}",
            "\t".join(("Variables", "Temperature", *_ALL)),
            "\t".join(("Units", "°C", *(unit for unit, _ in _ALL.values()))),
        ]
        for j, hertz in enumerate(HERTZ):
            point = hertz, STORAGE[i, j], LOSS[i, j]
            cells = [_written(value(*point)) for _, value in _ALL.values()]
            lines.append("\t".join(("Data point", f"{celsius:g}", *cells)))
        lines.append("")
    return ("\r\n".join(lines) + "\r\n").encode()


def trios_json():
    """Rows of cells by name, a row a line; the steps are told apart by an id."""
    units = {"Temperature": "°C"} | {name: unit for name, (unit, _) in _ALL.items()}
    keys = {name: f"{name}_{unit}" if unit else name for name, unit in units.items()}
    head = ", ".join(
        json.dumps(keys[name])
        + ": "
        + json.dumps({"DisplayName": name, "ValueType": "Number"} | _unit(unit))
        for name, unit in units.items()
    )
    rows = []
    for i, celsius in enumerate(CELSIUS):
        for j, hertz in enumerate(HERTZ):
            point = hertz, STORAGE[i, j], LOSS[i, j]
            cells = {keys[name]: value(*point) for name, (_, value) in _ALL.items()}
            # 12 digits, and only in the sweep that measured it
            cells = {k: float(_written(v)) if k != "Status bits" else v for k, v in cells.items()}
            cells[keys["Temperature"]] = celsius
            rows.append(json.dumps(cells | {"Results Step Id": f"step-{i}"}))
    text = (
        '{"Schema": {"Url": "x"},\n"Procedure": {"Configuration": '
        '{"Geometry": {"Name": "Film tension"}}},\n"Results": {"Original": {\n"ColumnHeaders": {'
        + head
        + ', "Results Step Id": {"DisplayName": "Results Step Id", "ValueType": "Uuid"}},\n'
        + '"Rows": [\n'
        + ",\n".join(rows)
        + "\n]}}}\n"
    )
    return text.encode()


def _unit(unit):
    return {"Unit": {"Name": unit}} if unit else {}


def wide(within=False):
    """The sweeps side by side, the temperature above the columns or within each heading."""
    above = [""] + [cell for celsius in CELSIUS for cell in (f"{celsius:g} °C", "")]
    names = ["f"] + [
        f"{name} {celsius:g} °C [MPa]" if within else name
        for celsius in CELSIUS
        for name in ("E'", "E''")
    ]
    units = ["Hz"] + ["" if within else "MPa"] * (2 * len(CELSIUS))
    lines = [names, units] if within else [above, names, units]
    for j, hertz in enumerate(HERTZ):
        pairs = zip(STORAGE[:, j], LOSS[:, j], strict=True)
        lines.append([f"{hertz:g}", *(f"{modulus:.8g}" for pair in pairs for modulus in pair)])
    return ("\n".join(",".join(cells) for cells in lines) + "\n").encode()


def polar(name="delta", unit="°"):
    """The complex modulus by its size and its angle, or by its size and the tangent."""
    lines = [f"Frequency (Hz);|E*| (MPa);{name} ({unit});Temp (°C)"]
    for celsius, hertz, storage, loss in rows():
        angle = {
            "°": np.degrees(np.arctan2(loss, storage)),
            "rad": np.arctan2(loss, storage),
            "-": loss / storage,
        }[unit]
        lines.append(f"{hertz:g};{np.hypot(storage, loss):.16g};{angle:.16g};{celsius:g}")
    return ("\n".join(lines) + "\n").encode()


def reptate_osc(celsius=-20.0, cells=11):
    """The rheometer's own fourteen headings, above rows that are shorter."""
    i = CELSIUS.index(celsius)
    lines = [f"T={celsius:g};Mw=94.9;chem=PDMS;"]
    names = "Freq G' G\" Temp Strain PhaseAngle Eta* Torque PhaseAngle Eta\" Eta' Temp tan_delta N"
    lines += [
        names.replace(" ", "\t"),
        "rad/s\tPa\tPa\t°C\t%\t°\tPa-s\tN-m\t°\tPa-s\tPa-s\t°C\t \tPa",
    ]
    for j, hertz in enumerate(HERTZ):
        first = (2 * np.pi * hertz, 1e6 * STORAGE[i, j], 1e6 * LOSS[i, j], celsius + 0.03)
        more = (1.97, 5.02, 7.1e3, 1.3e-4, 5.02, 333.0, 444.0)[: cells - 4]
        lines.append("    ".join(f"{x:.12g}" for x in first + more))
    return ("\n".join(lines) + "\n").encode("latin-1")


def workbook(path):
    """Write an .xlsx with the sheet that the Eplexor exports."""
    import openpyxl

    book = openpyxl.Workbook()
    book.active.title = "Data header"
    book.active.append(["Measurement type:", "Temp. Freq. Sweep"])
    sheet = book.create_sheet("Exported Data")
    sheet.append(["Nr", "Time", "f", "T", "E'", "E''", "|E*|", "tan delta", "F cont."])
    sheet.append(["", "s", "Hz", "°C", "MPa", "MPa", "MPa", "", "N"])
    for n, (celsius, hertz, storage, loss) in enumerate(rows()):
        sheet.append([n + 1, 60.0 * n, hertz, celsius, storage, loss, np.hypot(storage, loss),
                      loss / storage, "---"])  # fmt: skip
    book.save(path)


TEXTS = {
    "csv": plain(),
    "csv;": plain(separator=";", decimal=","),
    "csv tabs": plain(separator="\t"),
    "pyvisco": pyvisco(),
    "trios text": trios_lims(),
    "trios csv": trios_csv(),
    "rheocompass": rheocompass(),
    "rheocompass english": rheocompass(german=False),
    "trios all variables": trios_all(),
    "trios-json": trios_json(),
    "wide": wide(),
    "wide within": wide(within=True),
    "rheocompass csv": rheocompass(german=False, separator=",", encoding="utf-8"),
}
