"""Small files in the formats of laboratories, all of the same invented measurement.

Three sweeps of four frequencies, E' and E'' in MPa. The layouts follow the
instruments' exports; names and numbers are made up.
"""

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
    "rheocompass csv": rheocompass(german=False, separator=",", encoding="utf-8"),
}
