"""The gallery: every picture with a paragraph on what is seen, docs/gallery.md."""

from __future__ import annotations

from pathlib import Path
from textwrap import fill

from .figures.catalogue import figures
from .kept import kept
from .making import picture
from .whole import write_whole

DOCS = Path(__file__).resolve().parents[2] / "docs"
GALLERY, PICTURES = DOCS / "gallery.md", DOCS / "gallery"
_DPI = 64
_OPENING = (
    "Every figure and table of A. Maghami, PhD thesis (2025), that holds numbers, made by this "
    "package: `python -m research.replication gallery` writes this page from numbers that are "
    "kept in the repository, `python -m research.replication figure 4.6` one picture, with "
    "`--afresh` from nothing. "
    "Theory is a line, a simulation an open marker, a learned model a dot. What each claim is "
    "worth is in [the ledger](replication.md). Figures 1.1, 3.1, 3.2, 4.1, 5.1, 5.3, 5.4, 5.11 "
    "and A.2 of the thesis are photographs and sketches."
)

# What is seen.
SEEN = {
    "2.1": "At a depth of 2 the adhesive contact is 1.4 times as wide as that of Hertz and "
    "carries 30 % less. Its surface leaves the sphere upright, and its pressure turns into a "
    "tension without bound at the edge: the crack that the rest of the thesis moves.",
    "2.2a": "From loads of ten (rigid) to three hundred (JKR) Hertz is enough. Below them the "
    "Tabor number decides: rigid below 0.02, DMT up to 0.07, JKR from 1.6, a cohesive zone "
    "between. DMT reaches larger Tabor numbers under larger loads.",
    "2.2b": "At a Tabor number of 5 Maugis cannot be told from JKR, loop included; at 0.01 the "
    "force stays at that of rigid bodies outside the contact. Between them the loop opens, and "
    "the jump goes.",
    "table-3.1": "The six protocols. At b = 0.005 a all reach the strength; at 0.15 a, where "
    "they differ most, the stresses lie 1.4 % apart.",
    "3.3": "The envelope of the thesis as lines, the exact elastic stress dashed. They part over "
    "a decade around b1, where the exact one is 23.5 % higher; fast retraction moves b0 by 1/k "
    "and b1 not at all.",
    "3.4": "Six ways to press, six beginnings; counted from the depth without stress, one curve.",
    "3.5": "The markers of a thickness lie on each other. On the right the differences, largest "
    "where the layer passes from strength to crack, and inside the grey 2 % everywhere.",
    "3.6": "Four rates between the two elastic layers (dotted, simulated): none leaves them. The "
    "slope -1/2 is seen at the lowest rate; at 100 the strength lasts to ten times the "
    "thickness. Elastic theory lies above the elastic simulations by the length that the crack "
    "has run.",
    "3.7": "A layer of 0.001 a comes off as a whole. At 0.25 a a crack has come in by a tenth of "
    "the half width before the largest stress, at 10 a by a fifth, with the tension piled up at "
    "its tip.",
    "3.8": "The stress rises over three decades of crack speed to a plateau, which for the "
    "thinnest layer is the strength.",
    "3.9": "Energies follow Greenwood's curves up to where the size ends them; the layer of 13 "
    "a0, close to b0/k, stays a fifth below. On the right the bound is met if the whole contact "
    "is counted (dots), and passed with the ligament of Eq. 3.30.",
    "3.10": "A bell for each layer, seven works of adhesion high for the thickest. Its left end "
    "is 1.2 and not 1: the crack runs away at the end of the slowest retraction.",
    "4.2": "Broad spectra creep over many decades; n = 1.6 is nearly the standard solid. The "
    "dotted relaxation is that of the solids on the right: with the same n and tau0 the thesis's "
    "R(t) is of another material.",
    "4.3": "Faster, narrower and from farther out, the curves dive deeper below JKR; from 3.61 "
    "the force passes 15, which is 1.5/k.",
    "4.4": "One curve, Persson-Brener's, as long as the start is large enough; from 1.94 it ends "
    "at 11.",
    "4.5": "Left, forces that grow with the start, and level off. Right, the thresholds of all "
    "exponents on one line, which is not that of the thesis: 1.14 a^2.19 where it has 0.3 a^2.7.",
    "4.6": "Markers on lines over nine decades. The right panel magnifies: simulations are "
    "within 5 % of Persson-Brener with its fitted length (solid), and within 1.3 % of the steady "
    "crack, which has no fitted number, times the factor of the finite range (dotted), until "
    "Gamma comes close to 1/k.",
    "4.7": "The crack speed follows Eq. 4.24 as an order of magnitude. That the forces on the "
    "right lie within 15 % is owed to how little the force asks of the speed; small markers, k = "
    "0.01, leave the band.",
    "4.8": "The printed fit over eighteen decades, and eighteen arms fitted to it: 2 % in "
    "storage and 8 % in loss. The measured modulus is not published.",
    "4.9": "With 1.55 um the curve is the elastic one, and Carpick's fit reads its Tabor number. "
    "With the ranges that the rate series asks for the curve at the same speed lies lower and is "
    "read as JKR.",
    "4.10": "The thesis's linear curve (solid) is that of a range of 200 nm, star by star. With "
    "30.8 nm the forces are half as large again. What was measured leaves linear theory at some "
    "75 um/s.",
    "5.2": "Force by depth. The area above the curves is the work; the three starts of (d) end "
    "in one curve.",
    "table-5.1": "On the shipped set, whose inputs are continuous, all models err 1.4 to 5 times "
    "as much as on the thesis's, which has clusters of equal inputs; the forest is ahead of "
    "XGBoost.",
    "table-5.2": "With the descriptor the forest is best, and its error is 56 % lower than the "
    "best without.",
    "5.5": "For n = 0.2, where there are hardly rows, the model on the left steps and strays; "
    "with the descriptor it goes along the dashed law, which is as near to the simulations as it.",
    "5.6": "From 60 h0 the law, the model and the simulations are one. From 7.5 h0 the law ends "
    "at 10 and the truth at 6.5, and the model follows the truth.",
    "5.7": "At mu = 0.16 from 75 h0 the force ends at 12.5, well above 1/k: the passage to DMT, "
    "of which the law knows nothing. From 7.5 h0 the same solid ends below 6.",
    "5.8": "(a) the order of the Tabor numbers turns round at 11.5 h0. (b) there is no plateau: "
    "forces pass a maximum near 50 h0 and fall, for the bulk creeps. (c) beyond 3 h0 nothing "
    "matters much.",
    "table-5.3": "No work is a placeholder here, and errors are smaller than the thesis's, but "
    "for the tree. XGBoost is best, not the forest.",
    "table-5.4": "The descriptor takes half off the errors of tree and forest; XGBoost stays best.",
    "5.9": "Bells over the rate; the lines of the exponents cross near their tops. The forest "
    "without the descriptor moves in steps.",
    "5.10": "Works in the order of the Tabor numbers at every rate. The model is poor at mu = "
    "0.2, of which the set has no row.",
    "5.12": "More layers help, and rectifiers are ahead of the others throughout.",
    "5.13": "Six points of nine retractions that last from 4e-5 to 0.5 tau0. The network has the "
    "shapes and misses some points by a tenth of the largest force.",
    "A.1": "Persson-Brener with the same limit: the picture of Fig. 3.9 again.",
    "A.3": "A straight start of slope 1 for every n. On the right its coefficient: the printed "
    "one is pi n, which at k = 0.1 is a tenth too high. Exponents of the second law, drawn "
    "tenfold, come down to the limit n/(1 + n) only for much longer ranges of speed.",
    "A.4": "Linear regression sees the trend and misses the ends; XGBoost is on the line.",
    "A.5": "With the descriptor the clouds are thinner.",
    "table-A.1": "The shipped set has the mean, the spread and the range of the thesis's.",
    "A.6": "Squares are the estimate of Eq. 43 with the printed radii. It is close at mu = 0.8 "
    "and far above the simulations at small Tabor numbers.",
    "A.7": "Between its two ends the work is 2.4 times what is called its upper bound.",
    "A.8": "The error of rows held out has levelled off long before boosting stops.",
    "A.9": "After 20 trees nothing is gained, and nothing lost.",
    "histories": "A sphere pressed on fast and pulled at once holds up to 85 % less when pulled "
    "fast; pulled slowly it has forgotten. The punch of Fig. 3.5 stays in the grey band.",
    "alpha": "The ratio of stresses that makes Persson-Brener fit falls from 0.39 to 0.31 with "
    "the modulus ratio; pi/9 is a mean. The steady crack has its own, lower ones: part of pi/9 "
    "is the finite range.",
    "limits": "Slow forces lie on the elastic curve, fast ones approach f(mu k^(1/3)) instead of "
    "1, and the lens with 30.8 nm is the same by two independent routes.",
    "gent-schultz": "The exponent of the force rises and, from a light preload, falls again; "
    "0.27 is one point of it.",
    "published-rows": "Squares with bars are printed, dots are learned here from the authors' "
    "8,920 rows by their seeds: all 16 within the bars.",
    "linear-curve": "The six explanations that are nearest to the linear curve of Fig. 4.10. A "
    "range of 200 nm, which the thesis does not have, is nearest; 30.8 nm as the unit of the "
    "rate alone, at the Tabor number of the quasi-static test, comes next.",
    "printed-algorithm": "Up to a Tabor number of 3 equal nodes give the elastic force to 0.1 %. "
    "At 10 Newton's method gives up where the edge goes from node to node; from 30 on the edge "
    "stays at its node, and the tension grows for as long as the drive is moved.",
    "work-bound": "Each dot a simulated detachment. Where the range is short, on the right, none "
    "passes the bound; far left, where forces pull outside the contact, it does not apply.",
}


def text() -> str:
    """Return the page."""
    parts = ["# Gallery", fill(_OPENING, 108)]
    for each in figures():
        name = each.name
        parts.append(f"## {_head(name)}")
        parts.append(f"![{each.title}](gallery/{name.replace('.', '_')}.png)")
        parts.append(fill(f"{each.title} {SEEN[name]}", 108))
    return "\n\n".join(parts) + "\n"


def write() -> None:
    """Write the page and its pictures."""
    for each in figures():
        _smaller(picture(each.name, kept(each.name), PICTURES, dpi=_DPI))
    write_whole(GALLERY, text())


def _smaller(path: Path) -> None:
    """Write a picture again with the 256 colours that lines and words need."""
    from PIL import Image

    with Image.open(path) as drawn:
        few = drawn.convert("RGB").quantize(
            256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
        )
    few.save(path, optimize=True)


def _head(name: str) -> str:
    if name.startswith("table-"):
        return f"Table {name.removeprefix('table-')}"
    return f"Figure {name}" if name[0].isdigit() or name[0] == "A" else name.capitalize()
