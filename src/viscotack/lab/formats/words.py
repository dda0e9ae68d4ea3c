"""Headings of laboratory tables in the words and languages of instruments, by quantity.

Words are compared without spaces, underscores, hyphens, dots, accents and upper case.
"""

WORDS: dict[str, dict[str, str]] = {
    "material": {
        "frequency": (
            "freq frequency frequenz frequence frecuencia frequenza 频率 周波数 주파수 частота"
        ),
        "angular_frequency": (
            "ω omega angularfrequency angfrequency angfreq kreisfrequenz winkelfrequenz "
            "frequenceangulaire pulsation frecuenciaangular 角频率 角周波数 각주파수 угловаячастота"
        ),
        "temperature": "temp temperature temperatur temperatura 温度 온도 температура",
        "storage": (
            "elasticmodulus modulus(elasticcomponent) storage storagemodulus storagemod stormod "
            "speichermodul modulestockage moduledestockage moduledeconservation "
            "moduloalmacenamiento modulodealmacenamiento 储能模量 贮能模量 貯蔵弾性率 "
            "저장탄성률 저장탄성율 модульнакопления"
        ),
        "loss": (
            "viscousmodulus modulus(viscouscomponent) loss lossmodulus lossmod verlustmodul "
            "moduledeperte moduleperte moduloperdida modulodeperdida 损耗模量 損失弾性率 "
            "손실탄성률 손실탄성율 модульпотерь"
        ),
        "tan_delta": (
            "tandelta tand tanδ tan(delta) tan(δ) lossfactor verlustfaktor dampingfactor "
            "facteurdeperte factordeperdida 损耗因子 損失正接"
        ),
        "magnitude": (
            "complexmodulus modulus(complexcomponent) komplexermodul |complexmodulus| "
            "dynamicmodulus 复数模量 複素弾性率"
        ),
        "phase": (
            "phase phaseangle phaseshift phaseshiftangle delta δ lossangle phasenwinkel "
            "verlustwinkel phasenverschiebungswinkel angledephase 相位角 位相角"
        ),
        "time": "time zeit temps tiempo testtime testzeit 时间 時間 시간 время",
        "step_time": "steptime intervaltime segmenttime tseg abschnittszeit tempsdintervalle",
        "modulus": (
            "modulus modul relaxationmodulus stressrelaxationmodulus relaxationsmodul "
            "modulederelaxation 松弛模量 緩和弾性率"
        ),
        "compliance": "creepcompliance compliance kriechnachgiebigkeit complaisance 蠕变柔量",
        "stress": "stress spannung schubspannung contrainte tau τ σ 应力 応力 응력 напряжение",
        "strain": "strain dehnung deformation γ ɣ 应变 ひずみ 변형률 деформация",
        "sweep": "set sweep sweepnumber setnumber",
        "log10_shift": "logat log(at) logshift logshiftfactor",
        "shift": "at shiftfactor",
        "vertical_shift": "bt verticalshiftfactor",
        # other forms of the complex modulus
        "dynamic_viscosity": "dynamicviscosity dynamischeviskosität viscositédynamique",
        "elastic_viscosity": "elasticviscosity viscositéélastique",
        "complex_viscosity": (
            "complexviscosity complexdynamicviscosity komplexeviskosität viscositécomplexe"
        ),
        "storage_compliance": "storagecompliance speichernachgiebigkeit",
        "loss_compliance": "losscompliance verlustnachgiebigkeit",
    },
    # not read, but they identify flow curves and start-up tests
    "unread": {
        "shear_rate": "shearrate strainrate scherrate rate gammadot",
        "viscosity": "viscosity shearviscosity viskosität eta η apparentviscosity",
    },
    # symbols; E and D are tensile, G and J shear
    "symbols": {
        "storage": "E' Estor Estorage Eprime Ep G' Gstor Gstorage Gprime Gp",
        "loss": "E'' Eloss Edoubleprime Edprime Epp G'' Gloss Gdoubleprime Gdprime Gpp",
        "magnitude": "E* Ecomplex Eabs |E*| G* Gcomplex Gabs |G*|",
        "modulus": "E(t) Erelax G(t) Grelax",
        "compliance": "J(t) Jcreep D(t) Dcreep",
        "storage_compliance": "J' D'",
        "loss_compliance": "J'' D''",
        "dynamic_viscosity": "η' eta'",
        "elastic_viscosity": "η'' eta''",
        "complex_viscosity": "η* eta* |η*| |eta*|",
    },
    # single letters are case-sensitive
    "letters": {
        "f": "frequency",
        "w": "angular_frequency",
        "T": "temperature",
        "t": "time",
        "J": "compliance",
    },
    # words before a quantity that state tension or shear
    "kinds": {
        "E": "tensile tension extensional youngs zug traction flexural axial",
        "G": "shear schub scher cisaillement cizalla 剪切 せん断 전단",
    },
    # kind of modulus implied by a line on the geometry or by a neighbouring column
    "geometries": {
        "E": "tension tensile zug cantilever bending biegung compression druck",
        "G": (
            "shear scher schub torsion parallelplate platteplatte plateplate coneplate "
            "conicalplate kegelplatte concentric couette torque drehmoment"
        ),
    },
    # what stands beside the word for temperature: the sample, what is never it, parts of the rig
    "temperatures": {
        "sample": (
            "sample specimen proben echantillon muestra campione material actual act ist "
            "measured gemessene образца 样品 試料 시료"
        ),
        "room": "set soll target setpoint consigne nominal command ambient room raum umgebungs",
        "rig": (
            "oven ofen furnace chamber kammer plate platten bath bad probe lower upper bottom "
            "top air gas environment test stage tool"
        ),
        # before a temperature in a line above a table
        "test": "test sample probe chamber plate prüf mess proben",
    },
    # headings that tell samples, or places and states of a sample, apart, and their endings
    "apart": {
        "sample": (
            "sample samples specimen probe probekorper prufkorper muestra echantillon "
            "eprouvette campione material recipe rezept rezeptur formulation batch charge lot "
            "mixture compound 样品 試料 시료 образец"
        ),
        "place": (
            "position location spot place stelle ort segment cycle zyklus run test versuch "
            "state zustand condition phase repeat replicate measurement messung experiment step "
            "direction"
        ),
        "ending": "name id no nr number nummer nom label code #",
    },
    # tack tests and force curves
    "tack": {
        "force": (
            "force load normalforce kraft normalkraft standardkraft standardforce prufkraft "
            "last axialforce fn forcenormale effort charge fuerza carga verticalforce "
            "contactforce tipforce"
        ),
        "gap": (
            "gap spalt spaltbreite messspalt measuringgap separation tipsampleseparation "
            "entrefer plategap h"
        ),
        "depth": (
            "depth indentation indentationdepth penetration penetrationdepth eindringtiefe "
            "profondeur profundidad"
        ),
        "travel": (
            "travel extension displacement distance position crosshead crossheadtravel "
            "crossheadposition traverse traversenweg weg standardweg standardtravel "
            "verschiebung compressiveextension height zposition zheight deplacement "
            "desplazamiento stroke hub"
        ),
        "time": "time zeit testtime testzeit prufzeit elapsedtime totaltime temps tiempo t",
        "contact_radius": "contactradius kontaktradius rayondecontact",
        "contact_diameter": "contactdiameter kontaktdurchmesser",
        "contact_area": "contactarea kontaktflache airedecontact",
    },
    # unit in SI of quantities; others are pure numbers, temperatures or frequencies
    "units": {
        "Pa": "storage loss magnitude modulus stress",
        "1/Pa": "compliance storage_compliance loss_compliance",
        "Pa*s": "dynamic_viscosity elastic_viscosity complex_viscosity",
        "rad": "phase",
        "s": "time step_time",
        "N": "force",
        "m": "gap depth travel contact_radius contact_diameter",
        "m^2": "contact_area",
    },
}
